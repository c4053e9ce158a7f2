#include "nerf/capture/photometric_stereo.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "tests/support/input_error_of.h"
#include "tests/support/lit_sphere.h"

namespace nerf {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr double kGrey = 0.6;

StereoOptions By(StereoMethod method) {
  StereoOptions options;
  options.method = method;
  return options;
}

// The mean angle between estimated and true normals in degrees; also printed, for the README.
double MeanError(const std::vector<DirectionalLight>& lights,
                 const std::vector<test::SpherePixel>& sphere, StereoMethod method,
                 const char* name) {
  const PhotometricSolver solver(lights, By(method));
  double sum = 0;
  for (const auto& pixel : sphere) {
    sum += test::DegreesBetween(solver.Solve(pixel.observations).normal, pixel.normal);
  }
  const double mean = sum / static_cast<double>(sphere.size());
  std::cout << "mean angular error, " << name << ": " << mean << " degrees\n";
  return mean;
}

TEST(PhotometricStereo, IsExactForADiffuseSphereUnderTwelveLights) {
  const auto lights = test::RingOfLights(12, 45);
  const auto sphere = test::LitSphere(lights, kGrey);
  EXPECT_LT(MeanError(lights, sphere, StereoMethod::kAuto, "no noise, auto"), 0.05);
  EXPECT_LT(MeanError(lights, sphere, StereoMethod::kRobust, "no noise, robust"), 0.05);
}

TEST(PhotometricStereo, LeastSquaresAreExactWithoutShadows) {
  const auto lights = test::RingOfLights(12, 45);
  const PhotometricSolver solver(lights, By(StereoMethod::kLeastSquares));
  int compared = 0;
  for (const auto& pixel : test::LitSphere(lights, kGrey)) {
    if (std::ranges::any_of(pixel.observations, [](double b) { return b == 0; })) continue;
    const SurfaceEstimate estimate = solver.Solve(pixel.observations);
    ASSERT_LT(test::DegreesBetween(estimate.normal, pixel.normal), 1e-6);
    ASSERT_NEAR(estimate.albedo, kGrey, 1e-9);
    ASSERT_LT(estimate.residual, 1e-9);
    ++compared;
  }
  EXPECT_GT(compared, 1000);
}

TEST(PhotometricStereo, RobustMethodIgnoresShadowsAndHighlights) {
  const auto lights = test::RingOfLights(12, 45);
  const auto sphere = test::LitSphere(lights, kGrey, {.shadows = 0.1, .highlights = 0.1});
  const double plain = MeanError(lights, sphere, StereoMethod::kLeastSquares,
                                 "20 % shadows and highlights, least squares");
  EXPECT_GT(plain, 5);
  EXPECT_LT(MeanError(lights, sphere, StereoMethod::kRobust, "20 % shadows and highlights, robust"),
            1);
  EXPECT_LT(MeanError(lights, sphere, StereoMethod::kAuto, "20 % shadows and highlights, auto"), 1);
}

TEST(PhotometricStereo, RobustMethodIgnoresTwentyPercentOfEitherKind) {
  const auto lights = test::RingOfLights(24, 45);
  EXPECT_LT(MeanError(lights, test::LitSphere(lights, kGrey, {.shadows = 0.2}),
                      StereoMethod::kRobust, "20 % shadows, 24 lights"),
            1);
  EXPECT_LT(MeanError(lights, test::LitSphere(lights, kGrey, {.highlights = 0.2}),
                      StereoMethod::kRobust, "20 % highlights, 24 lights"),
            1);
}

TEST(PhotometricStereo, RobustMethodIsAccurateUnderNoise) {
  const auto lights = test::RingOfLights(12, 45);
  const auto sphere = test::LitSphere(lights, kGrey, {.noise = 0.01});
  EXPECT_LT(MeanError(lights, sphere, StereoMethod::kRobust, "1 % noise, robust"), 2.5);
  EXPECT_LT(MeanError(lights, sphere, StereoMethod::kAuto, "1 % noise, auto"), 2.5);
}

TEST(PhotometricStereo, AutoUsesLeastSquaresIfTheyFit) {
  const auto lights = test::RingOfLights(12, 30);
  const PhotometricSolver solver(lights, By(StereoMethod::kAuto));
  std::vector<double> observations;
  const Vector3d normal = Vector3d(0.1, -0.2, 0.9).normalized();
  for (const auto& light : lights) observations.push_back(light.to_light.dot(normal));
  EXPECT_FALSE(solver.Solve(observations).robust);
  observations[3] = 0;
  const SurfaceEstimate estimate = solver.Solve(observations);
  EXPECT_TRUE(estimate.robust);
  EXPECT_LT(test::DegreesBetween(estimate.normal, normal), 1e-3);
}

TEST(PhotometricStereo, IgnoresSaturatedObservations) {
  const auto lights = test::RingOfLights(6, 40);
  const Vector3d normal = Vector3d(0.1, 0.1, 0.9).normalized();
  for (const StereoMethod method :
       {StereoMethod::kLeastSquares, StereoMethod::kRobust, StereoMethod::kAuto}) {
    std::vector<double> observations;
    for (const auto& light : lights) observations.push_back(light.to_light.dot(normal));
    observations[2] = -1;
    const auto estimate = PhotometricSolver(lights, By(method)).Solve(observations);
    EXPECT_LT(test::DegreesBetween(estimate.normal, normal), 1e-5);
  }
}

TEST(PhotometricStereo, HasNoSolutionForDarkPixels) {
  const auto lights = test::RingOfLights(6, 40);
  const std::vector<double> dark(6, 0.0);
  for (const StereoMethod method :
       {StereoMethod::kLeastSquares, StereoMethod::kRobust, StereoMethod::kAuto}) {
    EXPECT_EQ(PhotometricSolver(lights, By(method)).Solve(dark).albedo, 0);
  }
}

// For random observations, too.
TEST(PhotometricStereo, NormalsAlwaysFaceTheCamera) {
  const auto lights = test::RingOfLights(7, 75);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const StereoMethod method :
       {StereoMethod::kLeastSquares, StereoMethod::kRobust, StereoMethod::kAuto}) {
    const PhotometricSolver solver(lights, By(method));
    int solved = 0;
    for (int pixel = 0; pixel < 5000; ++pixel) {
      std::vector<double> observations;
      for (std::size_t i = 0; i < lights.size(); ++i) {
        observations.push_back(std::pow(uniform(random), 2));
      }
      const SurfaceEstimate estimate = solver.Solve(observations);
      ASSERT_GT(estimate.normal.z(), 0) << pixel;
      solved += estimate.albedo > 0 ? 1 : 0;
    }
    EXPECT_GT(solved, 2500);
  }
}

// The frontal light is in a cast shadow, the other two graze the surface: the exact solution faces
// away.
TEST(PhotometricStereo, LeastSquaresHaveNoSolutionIfTheNormalWouldFaceAway) {
  std::vector<DirectionalLight> lights;
  std::vector<double> observations;
  for (const Vector3d& l : {Vector3d(1, 0, 0.2), Vector3d(0, 1, 0.2), Vector3d(0.5, 0.5, 0.7)}) {
    lights.push_back({l.normalized()});
    observations.push_back(std::max(0.0, l.normalized().dot(Vector3d(1.4, 1.4, -2))));
  }
  ASSERT_GT(observations[0], 0.5);
  const SurfaceEstimate estimate =
      PhotometricSolver(lights, By(StereoMethod::kLeastSquares)).Solve(observations);
  EXPECT_EQ(estimate.albedo, 0);
  EXPECT_GT(estimate.normal.z(), 0);
}

TEST(PhotometricStereo, RejectsFewerThanThreeLights) {
  EXPECT_THAT(test::InputErrorOf([] { PhotometricSolver(test::RingOfLights(2, 40), {}); }),
              HasSubstr("three or more"));
}

TEST(PhotometricStereo, RejectsCoplanarLights) {
  std::vector<DirectionalLight> lights;
  for (const double x : {-0.5, -0.2, 0.1, 0.4}) lights.push_back({Vector3d(x, x, 1).normalized()});
  EXPECT_THAT(test::InputErrorOf([&] { PhotometricSolver(lights, {}); }), HasSubstr("one plane"));
}

TEST(PhotometricStereo, RejectsOptionsOutOfRange) {
  const auto lights = test::RingOfLights(6, 40);
  StereoOptions options;
  options.dark = 2;
  EXPECT_THAT(test::InputErrorOf([&] { PhotometricSolver(lights, options); }), HasSubstr("--dark"));
  options = {};
  options.tolerance = 0;
  EXPECT_THAT(test::InputErrorOf([&] { PhotometricSolver(lights, options); }),
              HasSubstr("--tolerance"));
  options = {};
  options.max_residual = -1;
  EXPECT_THAT(test::InputErrorOf([&] { PhotometricSolver(lights, options); }),
              HasSubstr("--residual"));
}

}  // namespace
}  // namespace nerf
