#include "sfm/sparse_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "nerf/base/quantile.h"
#include "nerf/image/image_io.h"
#include "sfm/colmap_database.h"
#include "sfm/colmap_model.h"
#include "sfm/colmap_program.h"
#include "sfm/colmap_text_writer.h"
#include "sfm/pose_input.h"
#include "tests/support/fake_colmap.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scene_folder.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A capture with true poses and plain photographs, in which the fake COLMAP finds the features of a
// scene.
class SparsePointsOf : public testing::Test {
 protected:
  SparsePointsOf() {
    fake_.SetFeatures(test::WritePhotographsOf(scene_, photos_.path()));
    for (const PosedImage& image : scene_.posed.images) WriteImage(image.path, Picture(1));
    posed_ = scene_.posed;
  }
  // Opaque on the right of the middle, and as much on the left.
  static Image Picture(float left) {
    Image picture(640, 480, 4);
    for (int y = 0; y < 480; ++y) {
      for (int x = 0; x < 640; ++x) {
        const float pixel[4] = {0.8f, 0.4f, 0.2f, x < 320 ? left : 1.0f};
        std::copy_n(pixel, 4, picture.At(x, y));
      }
    }
    return picture;
  }
  SparsePointReport Find() { return FindSparsePoints(posed_, out_.path() / "points", {}); }
  void ExpectNothingOnTheLeft() const {
    EXPECT_GT(posed_.points.size(), 20u);
    for (const SparsePoint& point : posed_.points) {
      for (const TrackElement& element : point.track) EXPECT_GT(element.pixel.x(), 320);
    }
  }

  test::FakeColmap fake_;
  test::ScratchFolder photos_, out_;
  test::FeatureScene scene_ = test::FeatureScene({.images = 8, .points = 250});
  PosedImages posed_;
};

TEST_F(SparsePointsOf, GivenPosesAreTheTrueOnes) {
  const SparsePointReport report = Find();
  EXPECT_GT(report.points, 200);
  EXPECT_EQ(posed_.points.size(), static_cast<std::size_t>(report.points));
  EXPECT_GT(report.consistency.share, 0.95);
  EXPECT_GT(report.track_length, 4);
  for (const SparsePoint& point : posed_.points) {
    double nearest = 1;
    for (const Eigen::Vector3d& x : scene_.points) {
      nearest = std::min(nearest, (x - point.x_in_world).norm());
    }
    EXPECT_LT(nearest, 0.03);
    EXPECT_THAT(point.rgb, ElementsAre(204, 102, 51));
  }
  // The poses stay as they are.
  for (std::size_t i = 0; i < posed_.images.size(); ++i) {
    EXPECT_TRUE(
        posed_.images[i].world_from_camera.isApprox(scene_.posed.images[i].world_from_camera, 0));
  }
  EXPECT_THAT(Describe(report), HasSubstr("sparse points"));
}

TEST_F(SparsePointsOf, ASecondCallSkipsWhatIsDone) {
  const int points = Find().points;
  EXPECT_THAT(fake_.Commands(), ElementsAre("feature_extractor"));
  fake_.ForgetCalls();
  EXPECT_EQ(Find().points, points);
  EXPECT_THAT(fake_.Commands(), IsEmpty());
}

TEST_F(SparsePointsOf, WhatIsTransparentIsLeftOut) {
  for (const PosedImage& image : posed_.images) WriteImage(image.path, Picture(0));
  Find();
  ExpectNothingOnTheLeft();
}

TEST_F(SparsePointsOf, WhatIsMaskedIsLeftOut) {
  Image mask(640, 480, 1);
  for (int y = 0; y < 480; ++y) std::fill_n(mask.At(320, y), 320, 1.0f);
  WriteImage(photos_.path() / "mask.png", mask);
  for (PosedImage& image : posed_.images) image.mask = photos_.path() / "mask.png";
  Find();
  ExpectNothingOnTheLeft();
}

TEST_F(SparsePointsOf, PosesThatContradictThePhotographsAreNone) {
  for (PosedImage& image : posed_.images) {
    image.world_from_camera.translation() = -image.world_from_camera.translation();
  }
  const SparsePointReport report = Find();
  EXPECT_TRUE(report.consistency.Contradicts());
  EXPECT_TRUE(posed_.points.empty());
}

TEST_F(SparsePointsOf, PhotographsOfAnotherSizeAreNamed) {
  posed_.cameras[0].width = 320;
  EXPECT_THAT(test::InputErrorOf([&] { Find(); }), AllOf(HasSubstr("p10"), HasSubstr("640x480")));
}

// By the installed COLMAP, from the same verified matches: each of its points that three or more
// photographs see, against the point of ours that shares a sighting.
TEST(TriangulationForReal, AgreesWithColmapsForNeighbouringPhotosOfTheFox) {
  PosedImages posed =
      ReadPosedInput(FindInput(fs::path(NERF_TEST_DATA) / "fox" / "transforms.json"));
  posed.images.resize(8);
  const test::ScratchFolder out;
  ColmapOptions options;
  options.max_image_size = 960;
  FindSparsePoints(posed, out.path() / "points", options);
  PosedImages without = posed;
  without.points.clear();
  const ColmapDatabase database(out.path() / "points" / "database.db");
  for (std::size_t i = 0; i < posed.images.size(); ++i)
    without.images[i].name = database.Names()[i];
  fs::create_directories(out.path() / "given");
  fs::create_directories(out.path() / "theirs");
  WriteColmapText(without, out.path() / "given");
  const std::vector<std::string> arguments = {
      "--database_path", (out.path() / "points" / "database.db").string(),
      "--image_path",    (out.path() / "points" / "images").string(),
      "--input_path",    (out.path() / "given").string(),
      "--output_path",   (out.path() / "theirs").string(),
      "--clear_points",  "1"};
  ASSERT_EQ(ColmapProgram::Find()
                .Run("point_triangulator", arguments, out.path() / "log.txt", [](auto) {})
                .exit_code,
            0);
  const PosedImages theirs =
      ReadColmapModel(out.path() / "theirs", out.path() / "points" / "images");
  ASSERT_EQ(theirs.images.size(), posed.images.size());

  std::map<std::tuple<int, int, int>, const SparsePoint*> ours;  // by image and tenths of pixels
  const auto key = [](int image, const Eigen::Vector2d& pixel) {
    return std::tuple(image, static_cast<int>(10 * pixel.x()), static_cast<int>(10 * pixel.y()));
  };
  for (const SparsePoint& point : posed.points) {
    for (const TrackElement& e : point.track) ours[key(e.image, e.pixel)] = &point;
  }
  std::vector<double> relative;  // difference by distance from the camera
  int compared = 0;
  for (const SparsePoint& point : theirs.points) {
    if (point.track.size() < 3) continue;
    ++compared;
    for (const TrackElement& e : point.track) {
      const auto found = ours.find(key(e.image, e.pixel));
      if (found == ours.end()) continue;
      const Eigen::Vector3d camera = posed.images[e.image].world_from_camera.translation();
      relative.push_back((found->second->x_in_world - point.x_in_world).norm() /
                         (point.x_in_world - camera).norm());
      break;
    }
  }
  EXPECT_GT(compared, 2000);
  EXPECT_GE(std::ssize(relative), 0.95 * compared);
  EXPECT_NEAR(std::ssize(posed.points), compared, 0.1 * compared);
  EXPECT_LT(Quantile(relative, 0.5), 1e-5);
  EXPECT_LT(Quantile(relative, 0.9), 2e-3);  // where the tracks differ
}

}  // namespace
}  // namespace nerf::sfm
