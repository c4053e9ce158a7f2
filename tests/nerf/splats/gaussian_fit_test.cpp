#include "nerf/splats/gaussian_fit.h"

#include <gtest/gtest.h>

#include <cstring>

#include "nerf/base/parallel.h"
#include "nerf/scene/camera.h"
#include "nerf/selfcheck/gaussian_scene.h"
#include "nerf/splats/gaussian_camera.h"
#include "nerf/splats/initial_gaussians.h"

namespace nerf {
namespace {

constexpr double kNear = 0.02;

// Photographs of Gaussians from five places.
std::vector<View> Photographs(const GaussianCloud& cloud) {
  std::vector<View> views;
  for (int i = 0; i < 5; ++i) {
    View view;
    view.camera = PinholeFromFov(50, 44, 0.7);
    view.normalized_from_camera = Eigen::Isometry3d::Identity();
    view.normalized_from_camera.translation() = Eigen::Vector3d(0.3 * i - 0.6, 0.1 * (i % 2), 0);
    GaussianRenderer renderer;
    const GaussianPicture& picture = renderer.Draw(
        MakeGaussianCamera(view.camera, view.normalized_from_camera, kNear), cloud.Parameters());
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        for (int c = 0; c < 3; ++c) {
          view.rgba.push_back(static_cast<Eigen::half>(picture.Plane(c)[y * picture.stride + x]));
        }
        view.rgba.push_back(static_cast<Eigen::half>(1.0f));
      }
    }
    views.push_back(std::move(view));
  }
  return views;
}

GaussianCloud Scene() {
  GaussianCloud cloud(60, 0);
  const std::vector<float> values = InBlocks(RandomGaussians(60, 0, 5), 0);
  std::memcpy(cloud.parameters.data_ptr<float>(), values.data(), values.size() * sizeof(float));
  return cloud;
}

// Grey Gaussians somewhere about those of the scene.
GaussianCloud Start(std::int64_t count, int order) {
  std::vector<ColoredPoint> points;
  for (const reference::Gaussian& g : RandomGaussians(80, 0, 9)) {
    points.push_back({g.mean, Eigen::Vector3f(0.5f, 0.5f, 0.5f)});
  }
  return GaussiansAtPoints(points, count, order, 1);
}

SplatOptions Options() {
  SplatOptions options;
  options.split_every = 20;
  return options;
}

std::vector<float> Fit(const std::vector<View>& views, int steps, int order = 1) {
  GaussianFit fit(TargetViewsOf(views), false, BeginFit(Start(200, order)), Options(), kNear, 1);
  for (int i = 0; i < steps; ++i) {
    fit.Step({static_cast<double>(i) / steps, static_cast<double>(steps)});
  }
  const std::span<const float> values = fit.Cloud().Parameters().values;
  return {values.begin(), values.end()};
}

TEST(GaussianFit, FindsTheColoursOfPhotographs) {
  const std::vector<View> views = Photographs(Scene());
  GaussianFit fit(TargetViewsOf(views), false, BeginFit(Start(200, 0)), Options(), kNear, 1);
  constexpr int kSteps = 300;
  double first = 0, last = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double loss = fit.Step({static_cast<double>(i) / kSteps, kSteps});
    if (i < 10) first += loss / 10;
    if (i >= kSteps - 10) last += loss / 10;
  }
  EXPECT_LT(last, 0.3 * first);
}

TEST(GaussianFit, IsTheSameBitsForAnyNumberOfThreads) {
  const std::vector<View> views = Photographs(Scene());
  const int before = NumThreads();
  std::vector<std::vector<float>> results;
  for (const int threads : {1, 2, 3}) {
    SetNumThreads(threads);
    results.push_back(Fit(views, 60));
  }
  SetNumThreads(before);
  for (const auto& result : results) {
    ASSERT_EQ(result.size(), results[0].size());
    EXPECT_EQ(std::memcmp(result.data(), results[0].data(), result.size() * sizeof(float)), 0);
  }
}

// Across a split, and within a round of the photographs.
TEST(GaussianFit, GoesOnFromItsStateInTheSameBits) {
  const std::vector<View> views = Photographs(Scene());
  constexpr int kSteps = 60, kBefore = 31;
  const auto progress = [](std::int64_t step) {
    return FitProgress{static_cast<double>(step) / kSteps, kSteps};
  };
  GaussianFit first(TargetViewsOf(views), false, BeginFit(Start(200, 1)), Options(), kNear, 1);
  while (first.Steps() < kBefore) first.Step(progress(first.Steps()));
  GaussianFit second(TargetViewsOf(views), false, first.State(), Options(), kNear, 1);
  while (second.Steps() < kSteps) second.Step(progress(second.Steps()));
  const std::vector<float> whole = Fit(views, kSteps);
  const std::span<const float> values = second.Cloud().Parameters().values;
  ASSERT_EQ(values.size(), whole.size());
  EXPECT_EQ(std::memcmp(values.data(), whole.data(), whole.size() * sizeof(float)), 0);
}

// A sky: of a scene of which all is a thousand times as far away, means move as far in the picture.
TEST(GaussianFit, MeansMoveInProportionToTheirDistance) {
  const auto moved = [](double distance) {
    GaussianCloud scene(1, 0);
    const std::vector<View> views = Photographs(scene);
    const Eigen::Vector3d place = distance * Eigen::Vector3d(0.3, 0, 0.95);  // at the border
    GaussianCloud begin = GaussiansAtPoints({{place, Eigen::Vector3f(0.5f, 0.5f, 0.5f)}}, 16, 0, 1);
    for (int k = 0; k < 3; ++k) {
      begin.At(0, kernels::kLogScaleRow + k) = static_cast<float>(std::log(0.1 * distance));
    }
    SplatOptions options = Options();
    options.quarter_resolution = options.half_resolution = 0;
    GaussianFit fit(TargetViewsOf({views[2]}), false, BeginFit(begin), options, kNear, 1);
    fit.Step({0, 100});
    std::int64_t i = 0;  // of the only visible one
    while (fit.Cloud().At(i, kernels::kOpacityRow) < 0) ++i;
    const Eigen::Vector3d mean(fit.Cloud().At(i, 0), fit.Cloud().At(i, 1), fit.Cloud().At(i, 2));
    return (mean - place).norm() / distance;
  };
  const double near = moved(2);
  EXPECT_GT(near, 1e-3);
  EXPECT_NEAR(moved(1000), near, 0.05 * near);
}

TEST(GaussianFit, InvisibleGaussiansAreUsed) {
  const std::vector<View> views = Photographs(Scene());
  GaussianFit fit(TargetViewsOf(views), false, BeginFit(Start(200, 0)), Options(), kNear, 1);
  const auto visible = [&] {
    int count = 0;
    for (std::int64_t i = 0; i < fit.Cloud().count; ++i) {
      if (fit.Cloud().At(i, kernels::kOpacityRow) > -4) ++count;
    }
    return count;
  };
  EXPECT_EQ(visible(), 80);
  for (int i = 0; i < 100; ++i) fit.Step({i / 200.0, 200});
  EXPECT_GT(visible(), 100);
}

// The two are 1.5 times smaller, and the mean is between them.
TEST(GaussianFit, SplitsAGaussianAboutItsMean) {
  const std::vector<View> views = Photographs(Scene());
  const std::vector<ColoredPoint> one = {{Eigen::Vector3d(0, 0, 3), {0.9f, 0.2f, 0.1f}}};
  GaussianCloud cloud = GaussiansAtPoints(one, 2, 0, 1);  // the other is invisible
  for (int k = 0; k < 3; ++k) cloud.At(0, kernels::kLogScaleRow + k) = std::log(0.4f);
  SplatOptions options;
  options.split_every = 1;
  options.split_share = 0.5;
  options.mean_rate = options.scale_rate = options.rotation_rate = options.opacity_rate = 0;
  options.color_rate = options.harmonics_rate = 0;
  GaussianFit fit(TargetViewsOf(views), false, BeginFit(cloud), options, kNear, 1);
  fit.Step({0.1, 100});
  const GaussianCloud& two = fit.Cloud();
  double apart = 0;
  for (int k = 0; k < 3; ++k) {
    const float a = two.At(0, kernels::kMeanRow + k), b = two.At(1, kernels::kMeanRow + k);
    EXPECT_NEAR((a + b) / 2, k == 2 ? 3 : 0, 1e-5);
    apart += std::abs(a - b);
    for (const int i : {0, 1}) {
      EXPECT_NEAR(two.At(i, kernels::kLogScaleRow + k), std::log(0.4 / 1.5), 1e-5);
    }
  }
  EXPECT_GT(apart, 0.05);
}

// Points of COLMAP may have no colour, and black before black would have no gradient.
TEST(GaussianFit, BeginsAtPointsWithoutColour) {
  const std::vector<View> views = Photographs(Scene());
  std::vector<ColoredPoint> points;
  for (int i = 0; i < 60; ++i) {
    points.push_back({Eigen::Vector3d(i % 4 - 1.5, i / 4 % 4 - 1.5, i / 16 - 1.5) * 0.2,
                      Eigen::Vector3f::Zero()});
  }
  GaussianFit fit(TargetViewsOf(views), false, BeginFit(GaussiansAtPoints(points, 200, 0, 1)),
                  Options(), kNear, 1);
  double first = 0, last = 0;
  for (int i = 0; i < 200; ++i) {
    const double loss = fit.Step({i / 200.0, 200});
    if (i < 10) first += loss / 10;
    if (i >= 190) last += loss / 10;
  }
  EXPECT_LT(last, 0.7 * first);
}

// Beside what is not stored, pixels are not pulled to black by the windows of the structural loss.
TEST(GaussianFit, PixelsThatAreNotStoredDoNotCount) {
  std::vector<View> views = Photographs(Scene());
  const std::vector<View> whole = views;
  for (View& view : views) {
    std::vector<Eigen::half> kept;
    for (int y = 0; y < 44; ++y) {
      for (int x = 0; x < 50; ++x) {
        if ((x + y) % 3 == 0) continue;
        view.valid_pixels.push_back(static_cast<std::uint32_t>(y * 50 + x));
        for (int c = 0; c < 4; ++c) kept.push_back(view.rgba[4 * (y * 50 + x) + c]);
      }
    }
    view.rgba = std::move(kept);
  }
  const auto loss_after = [&](const std::vector<View>& of) {
    GaussianFit fit(TargetViewsOf(of), false, BeginFit(Start(200, 0)), Options(), kNear, 1);
    for (int i = 0; i < 300; ++i) fit.Step({i / 300.0, 300});
    GaussianFit check(TargetViewsOf(whole), false, BeginFit(fit.Cloud()), Options(), kNear, 1);
    return check.Step({0.9, 300});
  };
  EXPECT_LT(loss_after(views), 1.3 * loss_after(whole));
}

TEST(GaussiansAtPoints, AreAsLargeAsTheirSpacing) {
  std::vector<ColoredPoint> points;
  for (int i = 0; i < 27; ++i) {
    points.push_back({Eigen::Vector3d(i % 3, i / 3 % 3, i / 9) * 0.25, {1, 0.5f, 0}});
  }
  const GaussianCloud cloud = GaussiansAtPoints(points, 40, 2, 1);
  EXPECT_EQ(cloud.count, 40);
  for (std::int64_t i = 0; i < 27; ++i) {
    EXPECT_NEAR(cloud.At(i, kernels::kLogScaleRow), std::log(0.42 * 0.25), 1e-5);
    EXPECT_NEAR(cloud.At(i, kernels::kColorRow) * 0.28209479 + 0.5, 1, 1e-5);
    EXPECT_NEAR(1 / (1 + std::exp(-cloud.At(i, kernels::kOpacityRow))), 0.8, 1e-5);
  }
  EXPECT_LT(cloud.At(30, kernels::kOpacityRow), -10);
  EXPECT_EQ(GaussiansAtPoints(points, 10, 0, 1).count, 10);
}

TEST(SpatialOrder, PutsNeighboursNextToEachOther) {
  GaussianCloud cloud(64, 0);
  for (std::int64_t i = 0; i < 64; ++i) {
    const std::int64_t j = i * 37 % 64;
    for (int k = 0; k < 3; ++k) {
      cloud.At(i, kernels::kMeanRow + k) = static_cast<float>(j >> (2 * k) & 3);
    }
  }
  const GaussianCloud ordered = Reordered(cloud, SpatialOrder(cloud));
  double distance = 0;
  for (std::int64_t i = 1; i < 64; ++i) {
    for (int k = 0; k < 3; ++k) {
      distance +=
          std::abs(ordered.At(i, kernels::kMeanRow + k) - ordered.At(i - 1, kernels::kMeanRow + k));
    }
  }
  EXPECT_LT(distance / 63, 2);
}

}  // namespace
}  // namespace nerf
