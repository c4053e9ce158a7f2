#include "nerf/synthetic/camera_rings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "nerf/scene/camera.h"
#include "tests/support/input_error_of.h"

namespace nerf::synthetic {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;

double DegreesBetween(const Vector3d& a, const Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * 180 /
         std::numbers::pi;
}

TEST(CameraRings, HaveTheRequestedNumberOfViews) {
  for (const int views : {2, 3, 11, 12, 23, 24, 36, 101}) {
    SampleOptions options;
    options.views = views;
    const PosedImages posed = CameraRings(options);
    ASSERT_EQ(static_cast<int>(posed.images.size()), views);
    std::set<std::string> names;
    for (const auto& image : posed.images) names.insert(image.name);
    EXPECT_EQ(static_cast<int>(names.size()), views);
  }
}

TEST(CameraRings, AreUprightAndLookAtTheSubject) {
  const PosedImages posed = CameraRings({});
  const Camera& camera = posed.cameras.at(0);
  for (const auto& image : posed.images) {
    const Matrix3d R = image.world_from_camera.linear();
    EXPECT_LT((R.transpose() * R - Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(R.determinant(), 1, 1e-12);
    EXPECT_NEAR(image.world_from_camera.translation().norm(), 3, 0.16);
    EXPECT_GT(image.world_from_camera.translation().z(), 0.4);
    // OpenCV axes: the camera's y axis points down.
    EXPECT_LT(R.col(1).z(), -0.4);
    const auto origin =
        PixelFromPoint(camera, image.world_from_camera.inverse() * Vector3d::Zero());
    ASSERT_TRUE(origin.has_value());
    EXPECT_LT((*origin - PrincipalPoint(camera)).norm(), 0.25 * camera.height);
  }
}

TEST(CameraRings, NeighboursHaveSimilarViewingDirections) {
  const PosedImages posed = CameraRings({});
  for (const auto& image : posed.images) {
    int neighbours = 0;
    for (const auto& other : posed.images) {
      if (&other == &image) continue;
      neighbours += DegreesBetween(image.world_from_camera.translation(),
                                   other.world_from_camera.translation()) < 27;
    }
    EXPECT_GE(neighbours, 2) << image.name;
  }
}

TEST(CameraRings, SurroundTheSubject) {
  const PosedImages posed = CameraRings({});
  Vector2d mean = Vector2d::Zero();
  for (const auto& image : posed.images) {
    mean += image.world_from_camera.translation().head<2>() / posed.images.size();
  }
  EXPECT_LT(mean.norm(), 0.2);
}

TEST(CameraRings, AnotherSeedMovesEveryCameraSlightly) {
  SampleOptions other;
  other.seed = 2;
  const PosedImages a = CameraRings({});
  const PosedImages b = CameraRings(other);
  for (std::size_t i = 0; i < a.images.size(); ++i) {
    const double moved =
        (a.images[i].world_from_camera.translation() - b.images[i].world_from_camera.translation())
            .norm();
    EXPECT_GT(moved, 1e-4);
    EXPECT_LT(moved, 0.5);
  }
}

TEST(SampleOptions, ErrorsNameTheFlag) {
  const auto error_with = [](auto change) {
    SampleOptions options;
    change(options);
    return test::InputErrorOf([&] { CameraRings(options); });
  };
  EXPECT_THAT(error_with([](SampleOptions& o) { o.views = 1; }),
              AllOf(HasSubstr("--views"), HasSubstr("is 1")));
  EXPECT_THAT(error_with([](SampleOptions& o) { o.views = 1001; }), HasSubstr("--views"));
  EXPECT_THAT(error_with([](SampleOptions& o) { o.width = 0; }), HasSubstr("--width"));
  EXPECT_THAT(error_with([](SampleOptions& o) { o.height = -3; }), HasSubstr("--height"));
  EXPECT_THAT(error_with([](SampleOptions& o) { o.height = 1 << 30; }), HasSubstr("--height"));
  EXPECT_THAT(error_with([](SampleOptions& o) { o.samples_per_pixel = 0; }),
              HasSubstr("--samples"));
  EXPECT_THAT(error_with([](SampleOptions& o) { o.threads = -1; }), HasSubstr("--threads"));
}

}  // namespace
}  // namespace nerf::synthetic
