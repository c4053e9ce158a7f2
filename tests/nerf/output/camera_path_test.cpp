#include "nerf/output/camera_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "nerf/base/input_error.h"

namespace nerf {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
const Vector3d kTarget(4, -3, 10);

PosedImages WithCamera() {
  PosedImages posed;
  posed.cameras.push_back({CameraModel::kOpenCV, 80, 60, {70, 72, 41, 29, 0.1, 0.0, 0.0, 0.0}});
  posed.source = "cameras.json";
  return posed;
}

void Add(PosedImages& posed, const std::string& name, const Isometry3d& world_from_camera) {
  PosedImage image;
  image.name = name;
  image.world_from_camera = world_from_camera;
  posed.images.push_back(image);
}

// Cameras on a ring of radius 3, 1.5 above the target, looking at it; z is up.
PosedImages Ring(int count) {
  PosedImages posed = WithCamera();
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * kPi * i / count + 0.3;
    const Vector3d center = kTarget + Vector3d(3 * std::cos(angle), 3 * std::sin(angle), 1.5);
    Add(posed, std::string(1, static_cast<char>('a' + i)),
        LookAt(center, kTarget, Vector3d::UnitZ()));
  }
  return posed;
}

// Cameras in a plane, all looking along +y.
PosedImages ForwardFacing() {
  PosedImages posed = WithCamera();
  posed.depth_range_in_world = {{2.0, 20.0}};
  for (int i = 0; i < 20; ++i) {
    const Vector3d center(0.3 * (i % 5 - 2), 0, 0.2 * (i / 5 - 1.5));
    Add(posed, "image" + std::to_string(i),
        LookAt(center, center + Vector3d::UnitY(), Vector3d::UnitZ()));
  }
  return posed;
}

Vector3d Center(const PathPose& pose) { return pose.world_from_camera.translation(); }
Vector3d Forward(const PathPose& pose) { return pose.world_from_camera.linear().col(2); }

void ExpectRotations(const CameraPath& path) {
  for (const PathPose& pose : path.poses) {
    const Matrix3d r = pose.world_from_camera.linear();
    EXPECT_LT((r.transpose() * r - Matrix3d::Identity()).norm(), 1e-9);
    EXPECT_GT(r.determinant(), 0);
  }
}

// The largest change between frames, including that from the last to the first.
double LongestStep(const CameraPath& path) {
  double longest = 0;
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    const PathPose& next = path.poses[(i + 1) % path.poses.size()];
    longest = std::max(longest, (Center(next) - Center(path.poses[i])).norm());
  }
  return longest;
}

CameraPath Orbit(const PosedImages& posed, int frames) {
  return OrbitPath(posed, posed.images.empty() ? SceneNormalization() : NormalizeScene(posed),
                   frames);
}
CameraPath Spiral(const PosedImages& posed, int frames) {
  return SpiralPath(posed, posed.images.empty() ? SceneNormalization() : NormalizeScene(posed),
                    frames);
}

TEST(LookAt, PutsTheTargetAheadAndUpUpwards) {
  const Isometry3d pose = LookAt({1, 2, 3}, {1, 7, 3}, Vector3d::UnitZ());
  EXPECT_LT((pose.inverse() * Vector3d(1, 7, 3) - Vector3d(0, 0, 5)).norm(), 1e-12);
  EXPECT_LT((pose.linear().col(1) + Vector3d::UnitZ()).norm(), 1e-12);  // y is down
  EXPECT_LT((pose.linear().col(0) - Vector3d::UnitX()).norm(), 1e-12);
}

TEST(LookAt, WorksAlongUp) {
  const Isometry3d pose = LookAt({0, 0, 3}, {0, 0, 0}, Vector3d::UnitZ());
  EXPECT_NEAR(pose.linear().determinant(), 1, 1e-12);
  EXPECT_LT((pose.linear().col(2) + Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(OrbitPath, IsACircleThatLooksAtTheTarget) {
  const CameraPath path = Orbit(Ring(9), 40);
  ASSERT_EQ(path.poses.size(), 40);
  ExpectRotations(path);
  for (const PathPose& pose : path.poses) {
    const Vector3d offset = Center(pose) - kTarget;
    EXPECT_NEAR(offset.head<2>().norm(), 3, 1e-6);
    EXPECT_NEAR(offset.z(), 1.5, 1e-6);
    EXPECT_LT((Forward(pose) + offset.normalized()).norm(), 1e-6);
    EXPECT_LT(pose.world_from_camera.linear()(2, 1), 0);  // y of the camera points down
  }
}

TEST(OrbitPath, StartsAtTheFirstCameraAndCloses) {
  const PosedImages ring = Ring(9);
  const CameraPath path = Orbit(ring, 40);
  EXPECT_LT((Center(path.poses[0]) - ring.images[0].world_from_camera.translation()).norm(), 1e-6);
  EXPECT_NEAR(LongestStep(path), 2 * 3 * std::sin(kPi / 40), 1e-6);
}

TEST(OrbitPath, LooksOutwardsIfTheCamerasDo) {
  PosedImages posed = WithCamera();
  for (int i = 0; i < 8; ++i) {
    const Vector3d out(std::cos(kPi * i / 4), std::sin(kPi * i / 4), 0);
    Add(posed, std::to_string(i), LookAt(out, 2 * out, Vector3d::UnitZ()));
  }
  for (const PathPose& pose : Orbit(posed, 12).poses) {
    EXPECT_GT(Forward(pose).dot(Center(pose)), 0.9);
  }
}

TEST(OrbitPath, UsesTheFirstLensWithoutDistortion) {
  const Camera camera = Orbit(Ring(5), 3).poses[2].camera;
  EXPECT_EQ(camera.model, CameraModel::kPinhole);
  EXPECT_EQ(camera.width, 80);
  EXPECT_EQ(camera.height, 60);
  EXPECT_THAT(camera.params, testing::ElementsAre(71, 71, 41, 29));
}

TEST(OrbitPath, HasATimeForEachPose) {
  const CameraPath path = Orbit(Ring(5), 4);
  EXPECT_DOUBLE_EQ(path.poses[0].seconds, 0);
  EXPECT_DOUBLE_EQ(path.poses[3].seconds, 3 / path.frames_per_second);
}

TEST(SpiralPath, StaysAmongTheCamerasAndLooksAtOneFocusAhead) {
  const CameraPath path = Spiral(ForwardFacing(), 60);
  ASSERT_EQ(path.poses.size(), 60);
  ExpectRotations(path);
  // The harmonic mean of the depths 2 and 20.
  const Vector3d focus(0, 2 / (1 / 2.0 + 1 / 20.0), 0);
  double widest = 0;
  for (const PathPose& pose : path.poses) {
    EXPECT_LE(std::abs(Center(pose).x()), 0.6 + 1e-9);
    EXPECT_LE(std::abs(Center(pose).z()), 0.3 + 1e-9);
    EXPECT_LT(((focus - Center(pose)).normalized() - Forward(pose)).norm(), 1e-6);
    widest = std::max(widest, std::abs(Center(pose).x()));
  }
  EXPECT_NEAR(widest, 0.6, 1e-6);
}

TEST(SpiralPath, MakesTwoTurnsAndCloses) {
  const CameraPath path = Spiral(ForwardFacing(), 64);
  int crossings = 0;
  for (std::size_t i = 0; i < 64; ++i) {
    crossings +=
        (Center(path.poses[i]).x() > 1e-9) != (Center(path.poses[(i + 1) % 64]).x() > 1e-9);
  }
  EXPECT_EQ(crossings, 4);
  EXPECT_LT(LongestStep(path), 0.6 * 4 * kPi / 64 * 1.01);
}

TEST(SpiralPath, OfOneCameraStaysThere) {
  const CameraPath path = Spiral(Ring(1), 5);
  for (const PathPose& pose : path.poses) {
    EXPECT_LT((Center(pose) - Center(path.poses[0])).norm(), 1e-9);
    EXPECT_TRUE(pose.world_from_camera.matrix().allFinite());
  }
}

TEST(TrainingPath, PassesThroughEveryCameraInOrderOfName) {
  PosedImages ring = Ring(7);
  const std::vector<PosedImage> by_name = ring.images;
  std::ranges::reverse(ring.images);
  const CameraPath path = TrainingPath(ring, 6 * 10 + 1);
  ASSERT_EQ(path.poses.size(), 61);
  ExpectRotations(path);
  for (std::size_t i = 0; i < by_name.size(); ++i) {
    EXPECT_LT(
        (path.poses[10 * i].world_from_camera.matrix() - by_name[i].world_from_camera.matrix())
            .norm(),
        1e-7)
        << i;
  }
}

TEST(TrainingPath, MovesAndTurnsWithoutJerks) {
  const CameraPath path = TrainingPath(Ring(8), 7 * 50 + 1);
  // Except at the ends, the speed changes little between frames.
  for (std::size_t i = 51; i + 52 < path.poses.size(); ++i) {
    const auto turn = [&](std::size_t k) {
      return Eigen::AngleAxisd(path.poses[k].world_from_camera.linear().transpose() *
                               path.poses[k + 1].world_from_camera.linear())
          .angle();
    };
    const auto step = [&](std::size_t k) {
      return (Center(path.poses[k + 1]) - Center(path.poses[k])).norm();
    };
    EXPECT_NEAR(turn(i) / turn(i - 1), 1, 0.05) << i;
    EXPECT_NEAR(step(i) / step(i - 1), 1, 0.05) << i;
  }
}

TEST(TrainingPath, IgnoresHeldOutCameras) {
  PosedImages ring = Ring(3);
  ring.images[0].split = Split::kTest;
  const CameraPath path = TrainingPath(ring, 2);
  EXPECT_LT((Center(path.poses[0]) - ring.images[1].world_from_camera.translation()).norm(), 1e-9);
  for (PosedImage& image : ring.images) image.split = Split::kTest;
  EXPECT_THROW(TrainingPath(ring, 2), InputError);
}

TEST(CameraPaths, RejectNoCamerasAndInvalidNumbersOfFrames) {
  for (const auto make : {Orbit, Spiral, TrainingPath}) {
    EXPECT_THROW(make(WithCamera(), 5), InputError);
    EXPECT_THROW(make(Ring(5), 0), InputError);
    EXPECT_THROW(make(Ring(5), 2'000'000'000), InputError);
    EXPECT_EQ(make(Ring(5), 1).poses.size(), 1);
  }
}

}  // namespace
}  // namespace nerf
