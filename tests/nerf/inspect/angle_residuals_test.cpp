#include "nerf/inspect/angle_residuals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace nerf {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Points at the origin seen from an arc of cameras, from -62 to 62 degrees off the z axis.
class SeenFromAnArc : public testing::Test {
 protected:
  static constexpr int kCameras = 26, kPoints = 60;

  SeenFromAnArc() {
    for (int i = 0; i < kCameras; ++i) {
      const double angle = AngleOf(i);
      PosedImage image;
      image.world_from_camera = Eigen::Translation3d(3 * std::sin(angle), 0, 3 * std::cos(angle));
      posed_.images.push_back(image);
    }
    posed_.points.resize(kPoints);
    for (auto& point : posed_.points) point.x_in_world.setZero();
    for (int p = 0; p < kPoints; ++p) {
      for (int i = 0; i < kCameras; ++i) colors_.seen.push_back({p, i, Eigen::Vector3f::Zero(), 0});
    }
  }
  static double AngleOf(int camera) { return (camera - 12.5) * 5 * kDegree; }

  //   residual  of a sighting, from the angle
  template <typename F>
  std::vector<AngleResiduals> With(F residual) {
    PhotographFit fit;
    for (const Sighting& s : colors_.seen) {
      fit.residuals.push_back(
          Eigen::Vector3f::Constant(static_cast<float>(residual(AngleOf(s.photograph)))));
    }
    return ResidualsByAngle(posed_, colors_, fit);
  }

  PosedImages posed_;
  TrackColors colors_;
};

TEST_F(SeenFromAnArc, GlossyResidualsGrowWithTheAngle) {
  const auto residuals = With([](double angle) { return -std::fabs(angle); });
  ASSERT_GE(residuals.size(), 12u);
  for (const AngleResiduals& one : residuals) {
    EXPECT_NEAR(one.quartiles[1] * kTexturelessVariation, one.degrees * kDegree, 1e-3);
    EXPECT_LE(one.quartiles[0], one.quartiles[1]);
    EXPECT_LE(one.quartiles[1], one.quartiles[2]);
  }
}

TEST_F(SeenFromAnArc, NoiseDoesNotDependOnTheAngle) {
  std::mt19937 generator(7);
  std::normal_distribution<double> noise(0, 0.1);
  for (const AngleResiduals& one : With([&](double) { return noise(generator); })) {
    EXPECT_NEAR(one.quartiles[1] * kTexturelessVariation, 0.067, 0.03) << one.degrees;
  }
}

TEST_F(SeenFromAnArc, ResidualsAreRelativeToTheTexture) {
  const double plain = With([](double) { return 0.1; }).front().quartiles[1];
  for (Sighting& s : colors_.seen) s.contrast = static_cast<float>(kTexturelessVariation);
  EXPECT_NEAR(With([](double) { return 0.1; }).front().quartiles[1], plain / 2, 1e-5);
}

TEST_F(SeenFromAnArc, PointsWithFewSightingsAreIgnored) {
  std::erase_if(colors_.seen, [](const Sighting& s) { return s.photograph >= 4; });
  EXPECT_TRUE(With([](double angle) { return angle; }).empty());
}

}  // namespace
}  // namespace nerf
