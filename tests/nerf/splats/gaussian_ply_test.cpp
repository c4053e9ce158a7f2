#include "nerf/splats/gaussian_ply.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <string>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/random.h"
#include "nerf/scene/camera.h"
#include "nerf/splats/gaussian_camera.h"
#include "nerf/splats/harmonics_rotation.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using testing::HasSubstr;

constexpr int kCount = 40;

Eigen::Matrix3d Turn() {
  return Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
}

GaussianCloud CloudOf(int order) {
  GaussianCloud cloud(kCount, order);
  for (std::int64_t i = 0; i < kCount; ++i) {
    for (int row = 0; row < kernels::GaussianRows(order); ++row) {
      const float u = 2 * RandomFloat(3, static_cast<std::uint64_t>(row), i) - 1;
      cloud.At(i, row) = row < kernels::kLogScaleRow     ? u
                         : row < kernels::kRotationRow   ? -2 + 0.5f * u
                         : row >= kernels::kColorRow + 3 ? 0.3f * u
                                                         : u;
    }
  }
  return cloud;
}

// The cloud in its own frame, and the file in that of the world, look the same.
class GaussianPlyOrder : public testing::TestWithParam<int> {};
TEST_P(GaussianPlyOrder, LooksTheSameInTheFrameOfTheInput) {
  const GaussianCloud cloud = CloudOf(GetParam());
  SceneNormalization frame;
  frame.scale = 2.5;
  frame.rotation = Turn();
  frame.translation = Eigen::Vector3d(0.3, -1, 2);
  test::ScratchFolder folder;
  const auto file = folder.path() / "scene.ply";
  WriteGaussianPly(file, cloud, frame);
  const GaussianPly read = ReadGaussianPly(file);
  EXPECT_EQ(read.left_out, 0);
  ASSERT_EQ(read.cloud.count, kCount);
  ASSERT_EQ(read.cloud.order, GetParam());
  const Camera camera = PinholeFromFov(48, 40, 0.9);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Turn().transpose();
  pose.translation() = pose.linear() * Eigen::Vector3d(0, 0, -4);
  GaussianRenderer here, there;
  const GaussianPicture& own =
      here.Draw(MakeGaussianCamera(camera, pose, 0.05), cloud.Parameters());
  const GaussianPicture& other =
      there.Draw(MakeGaussianCamera(camera, frame.WorldFromCamera(pose), 0.05 / frame.scale),
                 read.cloud.Parameters());
  double most = 0, drawn = 0;
  for (int plane = 0; plane < 4; ++plane) {
    for (int y = 0; y < own.height; ++y) {
      for (int x = 0; x < own.width; ++x) {
        const std::size_t at = static_cast<std::size_t>(y) * own.stride + x;
        most = std::max<double>(most, std::abs(own.Plane(plane)[at] - other.Plane(plane)[at]));
        if (plane == 3) drawn += 1 - own.Plane(plane)[at];
      }
    }
  }
  EXPECT_GT(drawn, 100);
  EXPECT_LT(most, 2e-3);
}
INSTANTIATE_TEST_SUITE_P(All, GaussianPlyOrder, testing::Values(0, 1, 2, 3));

TEST(HarmonicsRotation, LooksAlongTheTurnedDirection) {
  const Eigen::MatrixXd turned = HarmonicsRotation(3, Turn());
  const Eigen::VectorXd c = Eigen::VectorXd::LinSpaced(16, -1, 2);
  for (const Eigen::Vector3d& d : {Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(-1, 0.2, 0.1)}) {
    const Eigen::Vector3d unit = d.normalized();
    EXPECT_NEAR(HarmonicsAt(3, unit).dot(turned * c), HarmonicsAt(3, Turn() * unit).dot(c), 1e-12);
  }
}

// The layout of the reference, by hand: one Gaussian without higher harmonics.
TEST(GaussianPly, ReadsOtherOrdersAndTypesAndLeavesOutWhatIsNotFinite) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment by hand\nelement vertex 2\n"
      "property uchar red\nproperty double x\nproperty float y\nproperty float z\n"
      "property float opacity\nproperty float f_dc_0\nproperty float f_dc_1\n"
      "property float f_dc_2\nproperty float scale_0\nproperty float scale_1\n"
      "property float scale_2\nproperty float rot_0\nproperty float rot_1\nproperty float rot_2\n"
      "property float rot_3\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n";
  const auto add = [&](auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  for (const float y : {std::numeric_limits<float>::quiet_NaN(), 2.0f}) {
    add(std::uint8_t{7});
    add(1.5);
    add(y);
    for (int k = 0; k < 12; ++k) add(static_cast<float>(k));
  }
  test::ScratchFolder folder;
  const auto file = folder.path() / "scene.ply";
  WriteFileAtomically(file, bytes);
  const GaussianPly read = ReadGaussianPly(file);
  EXPECT_EQ(read.left_out, 1);
  ASSERT_EQ(read.cloud.count, 1);
  EXPECT_EQ(read.cloud.order, 0);
  EXPECT_EQ(read.cloud.At(0, kernels::kMeanRow), 1.5f);
  EXPECT_EQ(read.cloud.At(0, kernels::kMeanRow + 1), 2.0f);
  EXPECT_EQ(read.cloud.At(0, kernels::kMeanRow + 2), 0.0f);
  EXPECT_EQ(read.cloud.At(0, kernels::kColorRow), 2.0f);
  EXPECT_EQ(read.cloud.At(0, kernels::kLogScaleRow), 5.0f);
  EXPECT_EQ(read.cloud.At(0, kernels::kRotationRow), 8.0f);
  const double opacity =
      kernels::kMostOpacity / (1 + std::exp(-read.cloud.At(0, kernels::kOpacityRow)));
  EXPECT_NEAR(opacity, 1 / (1 + std::exp(-1.0)), 1e-5);
}

// Bytes at random places changed: refused, or read as finite Gaussians.
TEST(GaussianPly, HostileFilesAreRefusedOrRead) {
  test::ScratchFolder folder;
  const auto file = folder.path() / "scene.ply";
  WriteGaussianPly(file, CloudOf(1), SceneNormalization());
  const std::string whole = ReadWholeFile(file);
  int refused = 0, read = 0;
  for (std::uint64_t round = 0; round < 500; ++round) {
    std::string bytes = whole;
    for (std::uint64_t k = 0; k < 1 + round % 4; ++k) {
      const std::uint64_t random = RandomBits(5, round, k);
      // Every other change is in the header.
      const std::size_t most = k % 2 == 1 ? 700 : bytes.size();
      bytes[random % most] = static_cast<char>(random >> 40);
    }
    WriteFileAtomically(file, bytes);
    try {
      const GaussianPly result = ReadGaussianPly(file);
      ++read;
      for (const float value : result.cloud.Parameters().values) {
        ASSERT_TRUE(std::isfinite(value)) << round;
      }
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
  EXPECT_GT(read, 50);
}

TEST(GaussianPly, WhatIsDamagedIsNamed) {
  test::ScratchFolder folder;
  const auto file = folder.path() / "scene.ply";
  WriteGaussianPly(file, CloudOf(1), SceneNormalization());
  const std::string whole = ReadWholeFile(file);
  const auto error_of = [&](const std::string& bytes) {
    WriteFileAtomically(file, bytes);
    return test::InputErrorOf([&] { ReadGaussianPly(file); });
  };
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string bytes = whole;
    return error_of(bytes.replace(bytes.find(from), from.size(), to));
  };
  EXPECT_THAT(error_of("solid"), HasSubstr("scene.ply: is no PLY file"));
  EXPECT_THAT(error_of(whole.substr(0, whole.size() - 1)), HasSubstr("ends before its last"));
  EXPECT_THAT(with("vertex 40", "vertex 99999999999"), HasSubstr("ends before its last"));
  EXPECT_THAT(with("vertex 40", "vertex -1"), HasSubstr("has no vertices"));
  EXPECT_THAT(with("binary_little_endian", "ascii"), HasSubstr("not binary_little_endian"));
  EXPECT_THAT(with("float opacity", "float clearness"), HasSubstr("no property opacity"));
  EXPECT_THAT(with("float f_rest_3", "float g_rest_3"), HasSubstr("8 properties f_rest_*"));
  EXPECT_THAT(with("float nx", "half nx"), HasSubstr("nx has the type half"));
}

}  // namespace
}  // namespace nerf
