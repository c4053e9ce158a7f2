// Each camera model against its formula, computed by hand for one point.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "nerf/scene/camera.h"

namespace nerf {
namespace {

Camera CameraOf(CameraModel model, std::vector<double> params) {
  return {model, 200, 140, std::move(params)};
}

// The point (0.5, 0.25, 1): s = r^2 = 0.3125, u v = 0.125. Computed by hand from the formulae.
constexpr double kS = 0.3125;
const Eigen::Vector3d kPoint(1.0, 0.5, 2.0);

void ExpectPixel(const Camera& camera, double x, double y) {
  const auto pixel = PixelFromPoint(camera, kPoint);
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), x, 1e-9);
  EXPECT_NEAR(pixel->y(), y, 1e-9);
}

TEST(CameraModels, ProjectByTheFormulaOfPinholes) {
  ExpectPixel(CameraOf(CameraModel::kSimplePinhole, {100, 50, 40}), 100, 65);
  ExpectPixel(CameraOf(CameraModel::kPinhole, {100, 200, 50, 40}), 100, 90);
}

TEST(CameraModels, ProjectByTheFormulaOfRadial) {
  // 1 + 0.1 * 0.3125 = 1.03125
  ExpectPixel(CameraOf(CameraModel::kSimpleRadial, {100, 50, 40, 0.1}), 101.5625, 65.78125);
  // 1 + 0.1 * 0.3125 + 0.2 * 0.09765625 = 1.05078125
  ExpectPixel(CameraOf(CameraModel::kRadial, {100, 50, 40, 0.1, 0.2}), 102.5390625, 66.26953125);
}

TEST(CameraModels, ProjectByTheFormulaOfOpenCV) {
  // u' = 0.525390625 + 2 * 0.01 * 0.125 + 0.02 * (0.3125 + 0.5)   = 0.544140625
  // v' = 0.2626953125 + 2 * 0.02 * 0.125 + 0.01 * (0.3125 + 0.125) = 0.2720703125
  ExpectPixel(CameraOf(CameraModel::kOpenCV, {100, 200, 50, 40, 0.1, 0.2, 0.01, 0.02}), 104.4140625,
              94.4140625);
}

TEST(CameraModels, ProjectByTheFormulaOfFullOpenCV) {
  // The first four and the next four distortion parameters are k1 k2 p1 p2, k3 k4 k5 k6.
  const double n = 1 + 0.1 * kS + 0.2 * kS * kS + 0.3 * kS * kS * kS;
  const double d = 1 + 0.4 * kS + 0.5 * kS * kS + 0.6 * kS * kS * kS;
  ExpectPixel(CameraOf(CameraModel::kFullOpenCV,
                       {100, 200, 50, 40, 0.1, 0.2, 0.01, 0.02, 0.3, 0.4, 0.5, 0.6}),
              50 + 100 * (0.5 * n / d + 0.01875), 40 + 200 * (0.25 * n / d + 0.009375));
}

TEST(CameraModels, ProjectByTheFormulaOfFov) {
  const double r = std::sqrt(kS);
  const double factor = std::atan(2 * r * std::tan(0.4)) / (0.8 * r);
  ExpectPixel(CameraOf(CameraModel::kFov, {100, 200, 50, 40, 0.8}), 50 + 50 * factor,
              40 + 50 * factor);
}

TEST(CameraModels, ProjectByTheFormulaOfFisheyes) {
  const double r = std::sqrt(kS);
  const double t = std::atan(r);
  const double t2 = t * t;
  const auto expect = [&](CameraModel model, std::vector<double> params, double radial) {
    ExpectPixel(CameraOf(model, std::move(params)), 50 + 50 * t * radial / r,
                40 + 25 * t * radial / r);
  };
  expect(CameraModel::kSimpleRadialFisheye, {100, 50, 40, 0.1}, 1 + 0.1 * t2);
  expect(CameraModel::kRadialFisheye, {100, 50, 40, 0.1, 0.2}, 1 + 0.1 * t2 + 0.2 * t2 * t2);
  expect(CameraModel::kOpenCVFisheye, {100, 100, 50, 40, 0.1, 0.2, 0.3, 0.4},
         1 + 0.1 * t2 + 0.2 * t2 * t2 + 0.3 * std::pow(t2, 3) + 0.4 * std::pow(t2, 4));
}

TEST(CameraModels, ProjectByTheFormulaOfThinPrismFisheye) {
  // Tangential and prism terms act on the angle, not on its tangent.
  const double t = std::atan(std::sqrt(kS));
  const double u = 0.5 * t / std::sqrt(kS);
  const double v = 0.25 * t / std::sqrt(kS);
  const double s = t * t;
  const double radial = 1 + 0.1 * s + 0.2 * s * s + 0.3 * std::pow(s, 3) + 0.4 * std::pow(s, 4);
  const double x = u * radial + 2 * 0.01 * u * v + 0.02 * (s + 2 * u * u) + 0.005 * s;
  const double y = v * radial + 2 * 0.02 * u * v + 0.01 * (s + 2 * v * v) + 0.006 * s;
  ExpectPixel(CameraOf(CameraModel::kThinPrismFisheye,
                       {100, 200, 50, 40, 0.1, 0.2, 0.01, 0.02, 0.3, 0.4, 0.005, 0.006}),
              50 + 100 * x, 40 + 200 * y);
}

}  // namespace
}  // namespace nerf
