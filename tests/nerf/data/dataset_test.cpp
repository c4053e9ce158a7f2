#include "nerf/data/dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "nerf/data/camera.h"
#include "nerf/data/image_io.h"
#include "sfm/input_error.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using sfm::Split;

sfm::PosedImages Posed(int count) {
  sfm::PosedImages posed;
  posed.cameras.push_back(PinholeFromFov(4, 4, 1.0));
  posed.source = "test";
  for (int i = 0; i < count; ++i) {
    sfm::PosedImage image;
    image.name = fmt::format("{:03}.png", i);
    image.world_from_camera = Eigen::Isometry3d::Identity();
    posed.images.push_back(image);
  }
  return posed;
}

std::vector<int> IndicesOf(const sfm::PosedImages& posed, Split split) {
  std::vector<int> indices;
  for (std::size_t i = 0; i < posed.images.size(); ++i) {
    if (posed.images[i].split == split) indices.push_back(static_cast<int>(i));
  }
  return indices;
}

TEST(AssignSplits, EveryEighthImageByNameIsHeldOut) {
  sfm::PosedImages posed = Posed(50);
  std::ranges::reverse(posed.images);  // the order of the source does not matter
  AssignSplits(posed, DataOptions());
  std::ranges::reverse(posed.images);
  EXPECT_EQ(IndicesOf(posed, Split::kTest), (std::vector<int>{0, 8, 16, 24, 32, 40, 48}));
  EXPECT_EQ(IndicesOf(posed, Split::kValidation).size(), 1u);
  EXPECT_EQ(IndicesOf(posed, Split::kTrain).size(), 42u);
}

TEST(AssignSplits, ATestSetOfTheSourceIsKept) {
  sfm::PosedImages posed = Posed(40);
  posed.images[3].split = Split::kTest;
  AssignSplits(posed, DataOptions());
  EXPECT_EQ(IndicesOf(posed, Split::kTest), (std::vector<int>{3}));
}

TEST(AssignSplits, AFewPhotosAreAllTrainedOn) {
  sfm::PosedImages posed = Posed(2);
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

  Dataset Load() { return LoadDataset(posed_, DataOptions(), {}); }

  test::ScratchFolder folder_;
  sfm::PosedImages posed_;
};

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
  EXPECT_THROW(Load(), sfm::InputError);
}

TEST_F(LoadedDataset, AnImageOfAnotherSizeThanItsCameraIsLeftOut) {
  WriteImage(posed_.images[2].path, Image(5, 4, 3));
  const Dataset data = Load();
  ASSERT_EQ(data.skipped.size(), 1u);
  EXPECT_THAT(data.skipped[0],
              testing::AllOf(testing::HasSubstr("5x4"), testing::HasSubstr("4x4")));
}

TEST_F(LoadedDataset, LinearAndDisplayReferredImagesAreNotMixed) {
  posed_.images[0].path = folder_.path() / "linear.exr";
  WriteImage(posed_.images[0].path, Image(4, 4, 3, ColorEncoding::kLinear));
  EXPECT_THROW(Load(), sfm::InputError);
}

TEST_F(LoadedDataset, HeldOutPhotographsAreNotRead) {
  posed_.images[0].split = Split::kTest;
  std::filesystem::remove(posed_.images[0].path);
  const Dataset data = Load();
  EXPECT_EQ(data.train.size(), 2u);
  EXPECT_TRUE(data.skipped.empty());
}

}  // namespace
}  // namespace nerf
