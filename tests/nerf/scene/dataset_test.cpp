#include "nerf/scene/dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <optional>

#include "nerf/base/input_error.h"
#include "nerf/image/image_io.h"
#include "nerf/scene/camera.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

PosedImages Posed(int count) {
  PosedImages posed;
  posed.cameras.push_back(PinholeFromFov(4, 4, 1.0));
  posed.source = "test";
  for (int i = 0; i < count; ++i) {
    PosedImage image;
    image.name = fmt::format("{:03}.png", i);
    image.world_from_camera = Eigen::Isometry3d::Identity();
    posed.images.push_back(image);
  }
  return posed;
}

std::vector<int> IndicesOf(const PosedImages& posed, Split split) {
  std::vector<int> indices;
  for (std::size_t i = 0; i < posed.images.size(); ++i) {
    if (posed.images[i].split == split) indices.push_back(static_cast<int>(i));
  }
  return indices;
}

TEST(AssignSplits, EveryEighthImageByNameIsHeldOut) {
  PosedImages posed = Posed(50);
  std::ranges::reverse(posed.images);  // the order of the source does not matter
  AssignSplits(posed, DataOptions());
  std::ranges::reverse(posed.images);
  EXPECT_EQ(IndicesOf(posed, Split::kTest), (std::vector<int>{0, 8, 16, 24, 32, 40, 48}));
  EXPECT_EQ(IndicesOf(posed, Split::kValidation).size(), 1u);
  EXPECT_EQ(IndicesOf(posed, Split::kTrain).size(), 42u);
}

TEST(AssignSplits, ATestSetOfTheSourceIsKept) {
  PosedImages posed = Posed(40);
  posed.images[3].split = Split::kTest;
  AssignSplits(posed, DataOptions());
  EXPECT_EQ(IndicesOf(posed, Split::kTest), (std::vector<int>{3}));
}

TEST(AssignSplits, AFewPhotosAreAllTrainedOn) {
  PosedImages posed = Posed(2);
  AssignSplits(posed, DataOptions());
  EXPECT_EQ(IndicesOf(posed, Split::kTrain).size(), 2u);
}

class LoadedDataset : public testing::Test {
 protected:
  LoadedDataset() : posed_(Posed(3)) {
    for (int i = 0; i < 3; ++i) {
      Image image(4, 4, 3);
      std::ranges::fill(image.pixels, 0.25f * static_cast<float>(i + 1));
      posed_.images[i].path = folder_.path() / posed_.images[i].name;
      WriteImage(posed_.images[i].path, image);
    }
  }

  Dataset Load() { return LoadDataset(posed_, DataOptions(), masks_, {}); }

  // A mask that leaves the upper half, for the photograph in the middle.
  void MaskTheSecond(int width = 4, int height = 4) {
    posed_.images[1].mask = folder_.path() / "mask.png";
    Image mask(width, height, 3);
    std::fill_n(mask.pixels.begin(), 3 * width * height / 2, 1.0f);
    WriteImage(posed_.images[1].mask, mask);
  }

  test::ScratchFolder folder_;
  PosedImages posed_;
  std::optional<MaskMeaning> masks_;
};

TEST_F(LoadedDataset, MasksThatLeaveEverythingChangeNothing) {
  const Dataset plain = Load();
  posed_.images[1].mask = folder_.path() / "mask.png";
  Image white(4, 4, 3);
  std::ranges::fill(white.pixels, 1.0f);
  WriteImage(posed_.images[1].mask, white);
  for (const MaskMeaning meaning : {MaskMeaning::kIgnore, MaskMeaning::kEmpty}) {
    masks_ = meaning;
    const Dataset masked = Load();
    EXPECT_EQ(masked.has_alpha, plain.has_alpha);
    for (std::size_t i = 0; i < plain.train.size(); ++i) {
      EXPECT_EQ(masked.train[i].rgba, plain.train[i].rgba);
      for (int k = 0; k < 16; ++k) EXPECT_EQ(masked.train[i].PixelOf(k), k);
    }
  }
}

TEST_F(LoadedDataset, PixelsToIgnoreAreNotHeld) {
  MaskTheSecond();
  EXPECT_EQ(Load().train[1].Held(), 16);  // the effect is off
  masks_ = MaskMeaning::kIgnore;
  const Dataset data = Load();
  EXPECT_FALSE(data.has_alpha);
  EXPECT_EQ(data.train[0].Held(), 16);
  ASSERT_EQ(data.train[1].Held(), 8);
  for (int k = 0; k < 8; ++k) EXPECT_EQ(data.train[1].PixelOf(k), k);
  EXPECT_EQ(data.train[1].HeldNear(3), 3);
  EXPECT_EQ(data.train[1].HeldNear(15), 7);
}

TEST_F(LoadedDataset, PhotographsAmongLinearImagesBecomeLinearWhereTheyAreNotWhite) {
  Image radiance(4, 4, 3, ColorEncoding::kLinear);
  std::ranges::fill(radiance.pixels, 3.0f);
  posed_.images[0].path = folder_.path() / "0.exr";
  WriteImage(posed_.images[0].path, radiance);
  Image photograph(4, 4, 3);
  std::ranges::fill(photograph.pixels, 0.5f);
  std::fill_n(photograph.pixels.begin(), 3 * 4, 1.0f);  // the first row
  WriteImage(posed_.images[1].path, photograph);
  MaskTheSecond();  // leaves two rows
  masks_ = MaskMeaning::kIgnore;
  const Dataset data = Load();
  EXPECT_EQ(data.encoding, ColorEncoding::kLinear);
  EXPECT_EQ(data.made_linear, 2);
  EXPECT_EQ(data.train[0].Held(), 16);
  EXPECT_EQ(static_cast<float>(data.train[0].rgba[0]), 3.0f);
  ASSERT_EQ(data.train[1].Held(), 4);  // one row is white, two are masked out
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(data.train[1].PixelOf(k), 4 + k);
    EXPECT_NEAR(static_cast<float>(data.train[1].rgba[4 * k]), 0.216f, 2e-3f);
  }
}

TEST_F(LoadedDataset, AWhitePhotographAmongLinearImagesSaysNothing) {
  Image radiance(4, 4, 3, ColorEncoding::kLinear);
  posed_.images[0].path = folder_.path() / "0.exr";
  WriteImage(posed_.images[0].path, radiance);
  Image white(4, 4, 3);
  std::ranges::fill(white.pixels, 1.0f);
  WriteImage(posed_.images[1].path, white);
  const Dataset data = Load();
  EXPECT_EQ(data.train.size(), 2u);
  ASSERT_EQ(data.skipped.size(), 1u);
  EXPECT_THAT(data.skipped[0], testing::HasSubstr("001.png"));
}

TEST_F(LoadedDataset, EmptyPixelsAreTransparent) {
  MaskTheSecond();
  masks_ = MaskMeaning::kEmpty;
  const Dataset data = Load();
  EXPECT_TRUE(data.has_alpha);
  ASSERT_EQ(data.train[1].Held(), 16);
  for (int k = 0; k < 16; ++k) {
    EXPECT_EQ(static_cast<float>(data.train[1].rgba[4 * k + 3]), k < 8 ? 1.0f : 0.0f);
  }
}

TEST_F(LoadedDataset, AMaskOfAnotherSizeIsRefusedWithBothSizes) {
  MaskTheSecond(4, 2);
  masks_ = MaskMeaning::kIgnore;
  EXPECT_THAT(test::InputErrorOf([&] { Load(); }),
              testing::AllOf(testing::HasSubstr("mask.png"), testing::HasSubstr("4x2"),
                             testing::HasSubstr("4x4")));
}

TEST_F(LoadedDataset, AMaskThatIsNoImageIsNamed) {
  MaskTheSecond();
  std::ofstream(posed_.images[1].mask) << "none";
  masks_ = MaskMeaning::kIgnore;
  EXPECT_THAT(test::InputErrorOf([&] { Load(); }), testing::HasSubstr("mask.png"));
}

TEST_F(LoadedDataset, PhotographsThatAreTransparentEverywhereAreRefused) {
  for (const auto& image : posed_.images) WriteImage(image.path, Image(4, 4, 4));
  EXPECT_THAT(test::InputErrorOf([&] { Load(); }), testing::HasSubstr("transparent everywhere"));
}

TEST_F(LoadedDataset, HoldsThePixels) {
  const Dataset data = Load();
  ASSERT_EQ(data.train.size(), 3u);
  EXPECT_FALSE(data.has_alpha);
  EXPECT_EQ(data.train[1].rgba.size(), 64u);
  EXPECT_NEAR(static_cast<float>(data.train[1].rgba[0]), 128 / 255.0f, 1e-3f);
  EXPECT_EQ(static_cast<float>(data.train[1].rgba[3]), 1.0f);
}

TEST_F(LoadedDataset, ABrokenPhotographIsNamedAndLeftOut) {
  std::filesystem::resize_file(posed_.images[1].path, 40);
  const Dataset data = Load();
  EXPECT_EQ(data.train.size(), 2u);
  ASSERT_EQ(data.skipped.size(), 1u);
  EXPECT_THAT(data.skipped[0], testing::HasSubstr("001.png"));
}

TEST_F(LoadedDataset, WithoutAReadablePhotographThereIsNoTraining) {
  for (const auto& image : posed_.images) std::filesystem::resize_file(image.path, 0);
  EXPECT_THROW(Load(), InputError);
}

TEST_F(LoadedDataset, AnImageOfAnotherSizeThanItsCameraIsLeftOut) {
  WriteImage(posed_.images[2].path, Image(5, 4, 3));
  const Dataset data = Load();
  ASSERT_EQ(data.skipped.size(), 1u);
  EXPECT_THAT(data.skipped[0],
              testing::AllOf(testing::HasSubstr("5x4"), testing::HasSubstr("4x4")));
}

TEST_F(LoadedDataset, HeldOutPhotographsAreNotRead) {
  posed_.images[0].split = Split::kTest;
  std::filesystem::remove(posed_.images[0].path);
  const Dataset data = Load();
  EXPECT_EQ(data.train.size(), 2u);
  EXPECT_TRUE(data.skipped.empty());
}

// 500 photographs of 12 million pixels, as a person may bring them.
TEST(PlanData, HoldsNoMoreThanTheMemoryThatIsAllowed) {
  PosedImages posed = Posed(500);
  posed.cameras[0] = PinholeFromFov(4000, 3000, 1.0);
  AssignSplits(posed, DataOptions());
  DataOptions options;
  const DataPlan plan = PlanData(posed, options);
  EXPECT_EQ(plan.train + plan.validation + plan.held_out, 500);
  EXPECT_EQ(plan.held_out, 63);
  EXPECT_EQ(plan.pixels, 437 * std::int64_t{12'000'000});
  EXPECT_LE(plan.Bytes(), std::int64_t{1} << 30);
  EXPECT_GT(plan.Bytes(), (std::int64_t{1} << 30) - 1000);
  EXPECT_LE(437 * plan.HeldOf(12'000'000), plan.held);
  options.downscale = 40;  // 300 x 225
  const DataPlan small = PlanData(posed, options);
  EXPECT_EQ(small.held, small.pixels);
  EXPECT_EQ(small.HeldOf(300 * 225), 300 * 225);
}

TEST(View, HeldPixelsAreSpreadEvenlyAndAtRandom) {
  View view;
  view.camera = PinholeFromFov(100, 50, 1.0);
  view.rgba.resize(4 * 700);
  int repeated = 0;
  std::int64_t before = -1;
  for (std::int64_t k = 0; k < view.Held(); ++k) {
    const std::int64_t pixel = view.PixelOf(k);
    EXPECT_GE(pixel, 5000 * k / 700);
    EXPECT_LT(pixel, 5000 * (k + 1) / 700);
    repeated += pixel - before == 7;
    before = pixel;
  }
  EXPECT_LT(repeated, 200);  // no raster
  View other = view;
  other.seed = 1;
  EXPECT_NE(other.PixelOf(0) + other.PixelOf(1) * 5000, view.PixelOf(0) + view.PixelOf(1) * 5000);
  view.rgba.resize(4 * 5000);
  EXPECT_EQ(view.PixelOf(123), 123);
}

TEST(LoadDataset, AShareOfThePixelsIsThoseOfThePhotograph) {
  const test::ScratchFolder folder;
  PosedImages posed = Posed(2);
  posed.cameras[0] = PinholeFromFov(500, 400, 1.0);
  for (PosedImage& image : posed.images) {
    image.split = Split::kTrain;
    image.path = folder.path() / image.name;
    Image photo(500, 400, 3);
    for (int p = 0; p < 500 * 400; ++p) {
      photo.pixels[3 * p] = static_cast<float>(p % 500 % 256) / 255;
      photo.pixels[3 * p + 1] = static_cast<float>(p / 500 % 256) / 255;
    }
    WriteImage(image.path, photo);
  }
  DataOptions options;
  options.memory_mb = 1;  // of 3.05
  const Dataset data = LoadDataset(posed, options, {}, {});
  std::int64_t held = 0;
  for (const View& view : data.train) {
    held += view.Held();
    for (std::int64_t k = 0; k < view.Held(); k += 97) {
      const std::int64_t pixel = view.PixelOf(k);
      EXPECT_NEAR(static_cast<float>(view.rgba[4 * k]), pixel % 500 % 256 / 255.0, 1e-3);
      EXPECT_NEAR(static_cast<float>(view.rgba[4 * k + 1]), pixel / 500 % 256 / 255.0, 1e-3);
    }
  }
  EXPECT_LE(held * 8, 1 << 20);
  EXPECT_GT(held * 8, (1 << 20) - 32);
}

}  // namespace
}  // namespace nerf
