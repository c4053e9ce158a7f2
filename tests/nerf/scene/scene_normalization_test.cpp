#include "nerf/scene/scene_normalization.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "sfm/transforms_json.h"
#include "tests/support/input_error_of.h"

namespace nerf {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Half width of the view at distance 1: sqrt(40 / 100 * 10 / 25) / 2.
const Camera kCamera = {CameraModel::kPinhole, 40, 10, {100, 25, 20, 5}};
constexpr double kHalfWidth = 0.2;

Isometry3d LookAt(const Vector3d& from, const Vector3d& to, const Vector3d& up) {
  Isometry3d world_from_camera = Isometry3d::Identity();
  const Vector3d forward = (to - from).normalized();
  const Vector3d right = forward.cross(up).normalized();
  world_from_camera.linear() << right, forward.cross(right), forward;
  world_from_camera.translation() = from;
  return world_from_camera;
}

PosedImages Posed(const std::vector<Isometry3d>& poses) {
  PosedImages posed;
  posed.source = "synthetic";
  posed.cameras = {kCamera};
  for (const Isometry3d& pose : poses) {
    PosedImage image;
    image.name = std::to_string(posed.images.size());
    image.world_from_camera = pose;
    posed.images.push_back(image);
  }
  return posed;
}

// 24 cameras around a point at distance 3, at several heights.
PosedImages Orbit(const Vector3d& focus, double radius = 3) {
  std::vector<Isometry3d> poses;
  for (int i = 0; i < 24; ++i) {
    const double azimuth = 2 * std::numbers::pi * i / 24;
    const double height = 0.2 + 0.1 * (i % 4);
    const Vector3d direction = Vector3d(std::cos(azimuth), std::sin(azimuth), height).normalized();
    poses.push_back(LookAt(focus + radius * direction, focus, Vector3d::UnitZ()));
  }
  return Posed(poses);
}

PosedImages Forward(int count, double bend = 0) {
  std::vector<Isometry3d> poses;
  for (int i = 0; i < count; ++i) {
    const Vector3d from(0.1 * i - 0.05 * (count - 1), 0.02 * (i % 3 - 1), 0);
    poses.push_back(LookAt(from, from * (1 - bend) + Vector3d(0, 0, 10), -Vector3d::UnitY()));
  }
  return Posed(poses);
}

// A ring of cameras that look away from its middle.
PosedImages Outward(double ring, const Vector3d& centre) {
  std::vector<Isometry3d> poses;
  for (int i = 0; i < 12; ++i) {
    const double azimuth = 2 * std::numbers::pi * i / 12;
    const Vector3d direction(std::cos(azimuth), std::sin(azimuth), 0);
    const Vector3d from = centre + ring * direction;
    poses.push_back(LookAt(from, from + direction, Vector3d::UnitZ()));
  }
  return Posed(poses);
}

void AddPoint(PosedImages* posed, const Vector3d& x_in_world) {
  SparsePoint point;
  point.x_in_world = x_in_world;
  for (int i = 0; i < static_cast<int>(posed->images.size()); ++i) {
    point.track.push_back({i, Eigen::Vector2d::Zero()});
  }
  posed->points.push_back(point);
}

void ExpectSphere(const SceneNormalization& scene, const Vector3d& centre, double radius,
                  double tolerance = 1e-9) {
  EXPECT_LT((scene.WorldFromNormalized(Vector3d::Zero()) - centre).norm(), tolerance * radius);
  EXPECT_NEAR(scene.LengthWorldFromNormalized(1) / radius, 1, tolerance);
}

TEST(SceneNormalization, CentreOfAnOrbitIsTheOriginAndItsViewHasRadiusOne) {
  const SceneNormalization scene = NormalizeScene(Orbit({1, -2, 5}));
  ExpectSphere(scene, {1, -2, 5}, 3 * kHalfWidth);
  EXPECT_TRUE(scene.rotation.isIdentity(1e-9));
}

TEST(SceneNormalization, FewCamerasThatLookElsewhereDoNotShiftTheCentre) {
  PosedImages posed = Orbit(Vector3d::Zero());
  for (const int i : {0, 1, 2, 3}) {
    const Vector3d from = posed.images[i].world_from_camera.translation();
    posed.images[i].world_from_camera = LookAt(from, Vector3d(0, 1.5, 1), Vector3d::UnitZ());
  }
  ExpectSphere(NormalizeScene(posed), Vector3d::Zero(), 3 * kHalfWidth, 0.02);
}

TEST(SceneNormalization, WorldToNormalizedAndBackIsTheIdentity) {
  const PosedImages posed = Orbit({1, -2, 5});
  const SceneNormalization scene = NormalizeScene(posed);
  const Vector3d x(0.3, 7, -2);
  EXPECT_TRUE(scene.WorldFromNormalized(scene.NormalizedFromWorld(x)).isApprox(x, 1e-13));
  EXPECT_DOUBLE_EQ(scene.LengthWorldFromNormalized(scene.LengthNormalizedFromWorld(5)), 5);
  const Isometry3d pose = posed.images[3].world_from_camera;
  const Isometry3d normalized = scene.NormalizedFromCamera(pose);
  EXPECT_TRUE(normalized.linear().isUnitary(1e-13));
  EXPECT_TRUE(scene.WorldFromCamera(normalized).isApprox(pose, 1e-13));
  // A point before the camera stays on its ray, and its distance scales.
  const Vector3d x_in_camera(0.1, 0.2, 2);
  EXPECT_TRUE((normalized * (scene.scale * x_in_camera))
                  .isApprox(scene.NormalizedFromWorld(pose * x_in_camera), 1e-13));
}

// Rotation about z, the only freedom that the choice of the world leaves.
void ExpectEqualUpToTurnAboutZ(const std::vector<Isometry3d>& a, const std::vector<Isometry3d>& b,
                               double tolerance) {
  const Eigen::Matrix3d turn = b[0].linear() * a[0].linear().transpose();
  EXPECT_LT((turn.col(2) - Vector3d::UnitZ()).norm(), tolerance);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT((turn * a[i].linear() - b[i].linear()).norm(), tolerance);
    EXPECT_LT((turn * a[i].translation() - b[i].translation()).norm(), tolerance);
  }
}

std::vector<Isometry3d> NormalizedPoses(const PosedImages& posed) {
  const SceneNormalization scene = NormalizeScene(posed);
  std::vector<Isometry3d> poses;
  for (const PosedImage& image : posed.images) {
    poses.push_back(scene.NormalizedFromCamera(image.world_from_camera));
  }
  return poses;
}

TEST(SceneNormalization, UnitsAndFrameOfTheInputDoNotMatter) {
  PosedImages forward = Forward(9, 0.1);
  AddPoint(&forward, {0, 0, 8});
  for (const PosedImages& original : {Orbit({1, -2, 5}), forward, Outward(0.5, {1, 2, 3})}) {
    for (const double scale : {1e-3, 1.0, 1e4}) {
      PosedImages moved = original;
      const Eigen::Matrix3d rotation =
          Eigen::AngleAxisd(2.5, Vector3d(-1, 1, 0.4).normalized()).toRotationMatrix();
      const Vector3d offset = scale * Vector3d(200, -300, 50);
      for (PosedImage& image : moved.images) {
        Isometry3d& pose = image.world_from_camera;
        pose.translation() = scale * (rotation * pose.translation()) + offset;
        pose.linear() = rotation * pose.linear();
      }
      for (SparsePoint& point : moved.points) {
        point.x_in_world = scale * (rotation * point.x_in_world) + offset;
      }
      ExpectEqualUpToTurnAboutZ(NormalizedPoses(original), NormalizedPoses(moved), 1e-8);
    }
  }
}

TEST(SceneNormalization, FarFromTheOriginThePosesStayTheSame) {
  PosedImages far = Orbit(Vector3d::Zero());
  const Vector3d offset(1e6, -1e6, 1e6);
  for (PosedImage& image : far.images) image.world_from_camera.translation() += offset;
  ExpectEqualUpToTurnAboutZ(NormalizedPoses(Orbit(Vector3d::Zero())), NormalizedPoses(far), 1e-7);
  ExpectSphere(NormalizeScene(far), offset, 3 * kHalfWidth, 1e-7);
}

TEST(SceneNormalization, UpOfTheCamerasBecomesZ) {
  const SceneNormalization scene = NormalizeScene(Forward(5));
  EXPECT_TRUE((scene.rotation * -Vector3d::UnitY()).isApprox(Vector3d::UnitZ(), 1e-3));
}

TEST(SceneNormalization, UpOfCamerasThatLookDownIsBackward) {
  std::vector<Isometry3d> poses;
  for (int i = 0; i < 8; ++i) {
    const double azimuth = 2 * std::numbers::pi * i / 8;
    const Vector3d side(std::cos(azimuth), 0, std::sin(azimuth));
    poses.push_back(LookAt(side + Vector3d(0, 5, 0), side, side));
  }
  const SceneNormalization scene = NormalizeScene(Posed(poses));
  EXPECT_TRUE((scene.rotation * Vector3d::UnitY()).isApprox(Vector3d::UnitZ(), 1e-9));
}

TEST(SceneNormalization, DepthOfForwardFacingCamerasIsTakenFromTheDepthRange) {
  PosedImages posed = Forward(9, 0.3);
  posed.depth_range_in_world = {2, 6};
  ExpectSphere(NormalizeScene(posed), {0, 0, 3}, 3 * kHalfWidth, 0.01);
}

TEST(SceneNormalization, DepthOfForwardFacingCamerasIsTakenFromThePoints) {
  PosedImages posed = Forward(9);
  for (const double depth : {4., 5., 1000.}) AddPoint(&posed, {0, 0, depth});
  ExpectSphere(NormalizeScene(posed), {0, 0, 5}, 5 * kHalfWidth, 0.01);
}

TEST(SceneNormalization, DepthOfForwardFacingCamerasIsTakenFromTheirExtentAtLast) {
  const SceneNormalization scene = NormalizeScene(Forward(9));
  const Vector3d centre = scene.WorldFromNormalized(Vector3d::Zero());
  EXPECT_NEAR(centre.z(), 4 * 0.4, 0.02);
  EXPECT_NEAR(scene.LengthWorldFromNormalized(1), centre.z() * kHalfWidth, 1e-9);
}

TEST(SceneNormalization, CentreOfOutwardFacingCamerasIsThatOfTheCameras) {
  ExpectSphere(NormalizeScene(Outward(0.5, {1, 2, 3})), {1, 2, 3}, 1);
}

TEST(SceneNormalization, RadiusOfCamerasInOnePointIsTakenFromThePoints) {
  PosedImages posed = Outward(0, {1, 2, 3});
  ExpectSphere(NormalizeScene(posed), {1, 2, 3}, 1);
  for (const double depth : {4., 5., 1000.}) AddPoint(&posed, Vector3d(1, 2 + depth, 3));
  ExpectSphere(NormalizeScene(posed), {1, 2, 3}, 5);
}

TEST(SceneNormalization, SingleCameraLooksAtUnitDistanceOrAtItsPoints) {
  PosedImages posed = Forward(1);
  const Vector3d from = posed.images[0].world_from_camera.translation();
  ExpectSphere(NormalizeScene(posed), from + Vector3d(0, 0, 1), kHalfWidth);
  AddPoint(&posed, from + Vector3d(0, 0, 7));
  ExpectSphere(NormalizeScene(posed), from + Vector3d(0, 0, 7), 7 * kHalfWidth);
}

TEST(SceneNormalization, PosesBeyondDoubleArithmeticAreRefused) {
  PosedImages posed = Orbit(Vector3d::Zero());
  posed.images[5].world_from_camera.translation().x() = 1e308;
  posed.images[6].world_from_camera.translation().x() = -1e308;
  EXPECT_THAT(nerf::test::InputErrorOf([&] { NormalizeScene(posed); }),
              testing::HasSubstr("synthetic: the poses span"));
  const Isometry3d same = posed.images[0].world_from_camera;
  PosedImages tiny = Posed({same, same});
  tiny.depth_range_in_world = {1e-320, 1e-320};
  EXPECT_THAT(nerf::test::InputErrorOf([&] { NormalizeScene(tiny); }),
              testing::HasSubstr("synthetic: the poses span"));
}

TEST(SceneNormalization, CamerasOfTheFoxAreAroundIt) {
  const PosedImages posed = sfm::ReadTransformsJson(NERF_TEST_DATA "/fox/transforms.json");
  for (const Isometry3d& pose : NormalizedPoses(posed)) {
    EXPECT_GT(pose.translation().norm(), 0.5);
    EXPECT_LT(pose.translation().norm(), 5);
    EXPECT_GT(-pose.translation().normalized().dot(pose.linear().col(2)), 0.7);
    EXPECT_GT(-pose.linear()(2, 1), 0.5);  // the camera's up has much of z
  }
}

TEST(SceneNormalization, ChairIsAtTheOriginOfItsOwnWorld) {
  const PosedImages posed = sfm::ReadTransformsJson(NERF_TEST_DATA "/chair/transforms_train.json");
  const SceneNormalization scene = NormalizeScene(posed);
  EXPECT_LT(scene.WorldFromNormalized(Vector3d::Zero()).norm(), 0.05);
  EXPECT_NEAR(scene.LengthWorldFromNormalized(1), 4.03 * 0.36, 0.05);
}

}  // namespace
}  // namespace nerf
