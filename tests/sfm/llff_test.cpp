#include "sfm/llff.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <xtensor/xarray.hpp>
#include <xtensor/xnpy.hpp>

#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf::sfm {
namespace {

using nerf::test::InputErrorOf;
using nerf::test::ScratchFolder;
using testing::ElementsAre;
using testing::HasSubstr;

// Two images of 40x30 with f = 50. The first camera has the axes of the world; the second looks
// along world x with its down along -z.
xt::xarray<double> TwoPoses() {
  return {{0, 1, 0, 1, 30, 1, 0, 0, 2, 40, 0, 0, -1, 3, 50, 0.5, 8},
          {0, 0, -1, 4, 30, 0, -1, 0, 5, 40, -1, 0, 0, 6, 50, 0.7, 9}};
}

class Llff : public testing::Test {
 protected:
  void WritePoses(const std::string& bytes) { scratch_.Write("poses_bounds.npy", bytes); }
  void WritePoses(const xt::xarray<double>& poses) { WritePoses(xt::dump_npy(poses)); }
  void WriteImages(const std::string& folder, int width, int height) {
    scratch_.WriteImage(folder + "/b.ppm", width, height);
    scratch_.WriteImage(folder + "/a.ppm", width, height);
  }
  std::string ReadError() {
    return InputErrorOf([&] { ReadLlff(scratch_.path()); });
  }
  ScratchFolder scratch_;
};

TEST_F(Llff, AxesAreDownRightBackwards) {
  WritePoses(TwoPoses());
  WriteImages("images", 40, 30);
  const PosedImages posed = ReadLlff(scratch_.path());
  ASSERT_EQ(posed.images.size(), 2u);
  EXPECT_EQ(posed.images[0].name, "a.ppm");
  EXPECT_TRUE(posed.images[0].world_from_camera.linear().isIdentity(1e-15));
  EXPECT_EQ(posed.images[0].world_from_camera.translation(), Eigen::Vector3d(1, 2, 3));
  const Eigen::Matrix3d second = posed.images[1].world_from_camera.linear();
  EXPECT_TRUE(second.col(2).isApprox(Eigen::Vector3d(1, 0, 0), 1e-15));
  EXPECT_TRUE(second.col(1).isApprox(Eigen::Vector3d(0, 0, -1), 1e-15));
  EXPECT_THAT(posed.cameras,
              ElementsAre(Camera{CameraModel::kSimplePinhole, 40, 30, {50, 20, 15}}));
  EXPECT_EQ(posed.depth_range_in_world, (std::array<double, 2>{0.5, 9}));
}

TEST_F(Llff, SinglePrecisionAndFortranOrderAreRead) {
  WriteImages("images", 40, 30);
  WritePoses(xt::dump_npy(xt::xarray<float>(TwoPoses())));
  EXPECT_NEAR((*ReadLlff(scratch_.path()).depth_range_in_world)[1], 9, 1e-6);
  WritePoses(xt::dump_npy(xt::xarray<double, xt::layout_type::column_major>(TwoPoses())));
  EXPECT_EQ(ReadLlff(scratch_.path()).images[1].world_from_camera.translation(),
            Eigen::Vector3d(4, 5, 6));
}

TEST_F(Llff, LensIsScaledToReducedImages) {
  WritePoses(TwoPoses());
  WriteImages("images_8", 5, 4);
  WriteImages("images_4", 10, 7);
  const PosedImages posed = ReadLlff(scratch_.path());
  ASSERT_EQ(posed.cameras.size(), 1u);
  EXPECT_EQ(posed.cameras[0].width, 10);
  EXPECT_EQ(posed.cameras[0].height, 7);
  EXPECT_NEAR(posed.cameras[0].params[0], 50 * std::sqrt(10. / 40 * 7 / 30), 1e-12);
  EXPECT_DOUBLE_EQ(posed.cameras[0].params[1], 5);
  EXPECT_DOUBLE_EQ(posed.cameras[0].params[2], 3.5);
}

TEST_F(Llff, NumbersOfImagesAndPosesMustAgree) {
  WritePoses(TwoPoses());
  WriteImages("images", 40, 30);
  scratch_.WriteImage("images/c.ppm", 40, 30);
  EXPECT_THAT(ReadError(), HasSubstr("has 2 poses, but"));
  EXPECT_THAT(ReadError(), HasSubstr("has 3 images"));
}

TEST_F(Llff, UnreadableImageIsNamed) {
  WritePoses(TwoPoses());
  WriteImages("images", 40, 30);
  scratch_.Write("images/a.ppm", "");
  const PosedImages posed = ReadLlff(scratch_.path());
  EXPECT_THAT(posed.missing, ElementsAre("a.ppm (not a readable image)"));
  EXPECT_EQ(posed.images.size(), 1u);
}

TEST_F(Llff, InvalidRowsAreRefusedByImage) {
  WriteImages("images", 40, 30);
  const auto error_with = [&](int column, double value) {
    xt::xarray<double> poses = TwoPoses();
    poses(1, column) = value;
    WritePoses(poses);
    return ReadError();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error_with(3, nan), HasSubstr("row 1 (b.ppm): an entry is not finite"));
  EXPECT_THAT(error_with(2, 1), HasSubstr("row 1 (b.ppm): not a rigid motion"));
  EXPECT_THAT(error_with(14, 0),
              HasSubstr("row 1 (b.ppm): height 30, width 40 and focal length 0"));
  EXPECT_THAT(error_with(9, nan), HasSubstr("width nan"));
  EXPECT_THAT(error_with(15, -1), HasSubstr("nearest depth -1"));
  EXPECT_THAT(error_with(16, nan), HasSubstr("farthest depth nan"));
  EXPECT_THAT(error_with(9, 41), HasSubstr("no scaled copy"));
}

TEST_F(Llff, FileTruncatedAtAnyByteIsRefused) {
  WriteImages("images", 40, 30);
  const std::string whole = xt::dump_npy(TwoPoses());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    WritePoses(whole.substr(0, length));
    ASSERT_THAT(ReadError(), HasSubstr("not a complete NumPy array")) << length;
  }
}

TEST_F(Llff, HostileHeadersAreRefused) {
  WriteImages("images", 40, 30);
  const std::string whole = xt::dump_npy(TwoPoses());
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string bytes = whole;
    return bytes.replace(bytes.find(from), from.size(), to);
  };
  for (const std::string& bytes :
       {replaced("(2, 17)", "(9, 17)"), replaced("(2, 17)", "(34,1)"), replaced("<f8", ">f8"),
        replaced("<f8", "<i8"), replaced("shape", "sheep"), replaced("{", "\n"),
        replaced("(2, 17)", "(99999999999999999999999, 17)"), replaced("\x01", "\x02"),
        replaced("\x93", "\x92")}) {
    WritePoses(bytes);
    EXPECT_THAT(ReadError(), HasSubstr("not a complete NumPy array"));
  }
  WritePoses(xt::dump_npy(xt::xarray<double>(xt::xarray<double>::shape_type{0, 17})));
  EXPECT_THAT(ReadError(), HasSubstr("contains no poses"));
}

TEST_F(Llff, FolderWithoutImagesIsRefused) {
  WritePoses(TwoPoses());
  EXPECT_THAT(ReadError(), HasSubstr("neither a folder images nor images_N"));
}

}  // namespace
}  // namespace nerf::sfm
