#include "nerf/splats/gaussian_renderer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/kernels/simd_level.h"
#include "nerf/scene/camera_models.h"
#include "nerf/selfcheck/gaussian_scene.h"
#include "nerf/splats/gaussian_camera.h"

namespace nerf {
namespace {

using reference::Gaussian;
using reference::GaussianPixel;
using reference::GaussianView;

constexpr int kWidth = 43, kHeight = 37;  // not whole tiles

// A camera of every model, with a distortion of some percent at the corners.
Camera CameraOf(CameraModel model) {
  std::vector<double> params;
  switch (model) {
    case CameraModel::kSimplePinhole:
      params = {40, 21, 19};
      break;
    case CameraModel::kPinhole:
      params = {40, 38, 21, 19};
      break;
    case CameraModel::kSimpleRadial:
    case CameraModel::kSimpleRadialFisheye:
      params = {40, 21, 19, 0.08};
      break;
    case CameraModel::kRadial:
    case CameraModel::kRadialFisheye:
      params = {40, 21, 19, -0.12, 0.05};
      break;
    case CameraModel::kOpenCV:
      params = {40, 38, 21, 19, -0.1, 0.04, 0.01, -0.02};
      break;
    case CameraModel::kOpenCVFisheye:
      params = {40, 38, 21, 19, 0.05, -0.02, 0.01, 0.005};
      break;
    case CameraModel::kFullOpenCV:
      params = {40, 38, 21, 19, -0.1, 0.04, 0.01, -0.02, 0.01, 0.05, 0.02, 0.01};
      break;
    case CameraModel::kFov:
      params = {40, 38, 21, 19, 0.6};
      break;
    case CameraModel::kThinPrismFisheye:
      params = {40, 38, 21, 19, 0.05, -0.02, 0.01, -0.02, 0.01, 0.005, 0.01, -0.02};
      break;
  }
  return {model, kWidth, kHeight, params};
}

// A loss that weights all pixels and channels differently.
double WeightOf(int x, int y, int plane) {
  return std::cos(0.31 * x + 0.17 * y + 1.3 * plane) * (plane == 4 ? 0.3 : 1.0);
}

double LossOf(const std::vector<Gaussian>& gaussians, const GaussianView& view) {
  const std::vector<GaussianPixel> pixels = DrawGaussians(gaussians, view);
  double loss = 0;
  for (int y = 0; y < view.camera.height; ++y) {
    for (int x = 0; x < view.camera.width; ++x) {
      const GaussianPixel& pixel = pixels[static_cast<std::size_t>(y) * view.camera.width + x];
      for (int c = 0; c < 3; ++c) loss += WeightOf(x, y, c) * pixel.rgb[c];
      loss += WeightOf(x, y, 3) * pixel.transmittance + WeightOf(x, y, 4) * pixel.distance;
    }
  }
  return loss;
}

GaussianPicture WeightsOf(const GaussianPicture& picture) {
  GaussianPicture weights;
  weights.Resize(picture.width, picture.height);
  std::ranges::fill(weights.values, 0.0f);
  for (int plane = 0; plane < GaussianPicture::kPlanes; ++plane) {
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        weights.Plane(plane)[y * weights.stride + x] = static_cast<float>(WeightOf(x, y, plane));
      }
    }
  }
  return weights;
}

Eigen::Isometry3d SomePose() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 2, 3).normalized()));
  pose.translation() = Eigen::Vector3d(0.1, -0.05, 0.2);
  return pose;
}

struct Gradients {
  std::vector<float> parameters;
  kernels::CameraGradient pose;
};

// Draws, and takes the gradients of the loss.
Gradients GradientsOf(GaussianRenderer& renderer, const GaussianView& view,
                      const GaussianParameters& parameters) {
  const kernels::GaussianCamera camera =
      MakeGaussianCamera(view.camera, view.camera_from_normalized.inverse(), view.near);
  const GaussianPicture weights = WeightsOf(renderer.Draw(camera, parameters));
  Gradients gradients{std::vector<float>(parameters.values.size(), 0.0f), {}};
  gradients.pose = renderer.Backward(
      camera, parameters, weights, true,
      [&](std::int64_t block, std::span<float> of_block, std::span<const float>) {
        std::ranges::copy(of_block, gradients.parameters.begin() +
                                        block * static_cast<std::ptrdiff_t>(of_block.size()));
      });
  return gradients;
}

// With a step so small that no pixel passes the border where a Gaussian is cut.
double CentralDifference(const std::function<double(double)>& f) {
  constexpr double kStep = 1e-7;
  return (f(kStep) - f(-kStep)) / (2 * kStep);
}

// Row 50 of the hard cases: their tiles would not fit into memory.
TEST(TileLists, TooManyTilesAreRefusedWithTheirNumber) {
  kernels::ProjectedGaussian huge;
  huge.x = huge.y = 4000;
  huge.xx = huge.yy = -1e-12f;
  huge.least = -8;
  huge.radius_x = huge.radius_y = 1e6f;
  std::vector<kernels::ProjectedGaussian> gaussians(2000, huge);  // of 500,000 tiles each
  TileLists tiles;
  try {
    tiles.Build(gaussians, 8000, 8000);
    FAIL() << "expected an error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("2000 Gaussians cover more than 150 million"));
  }
}

class GaussiansOfEveryLens : public testing::TestWithParam<int> {
 protected:
  GaussianView view_{CameraOf(static_cast<CameraModel>(GetParam())), SomePose(), 0.02};
  std::vector<Gaussian> gaussians_ = RandomGaussians(20, 3, 7);
  const std::vector<float> blocks_ = InBlocks(gaussians_, 3);
  const kernels::GaussianCamera camera_ =
      MakeGaussianCamera(view_.camera, view_.camera_from_normalized.inverse(), view_.near);
};

TEST_P(GaussiansOfEveryLens, AreDrawnAsTheReference) {
  const std::vector<GaussianPixel> truth = DrawGaussians(gaussians_, view_);
  for (const kernels::SimdLevel& level : kernels::SimdLevels()) {
    SCOPED_TRACE(level.name);
    const kernels::WithSimdLevel use(level);
    GaussianRenderer renderer;
    const GaussianPicture& picture = renderer.Draw(camera_, {3, blocks_});
    double largest = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const GaussianPixel& pixel = truth[static_cast<std::size_t>(y) * kWidth + x];
        const double values[5] = {pixel.rgb[0], pixel.rgb[1], pixel.rgb[2], pixel.transmittance,
                                  pixel.distance / 3};
        for (int plane = 0; plane < 5; ++plane) {
          const double drawn = picture.Plane(plane)[y * picture.stride + x] / (plane == 4 ? 3 : 1);
          largest = std::max(largest, std::abs(drawn - values[plane]));
        }
      }
    }
    EXPECT_LT(largest, 3e-4);
  }
}

TEST_P(GaussiansOfEveryLens, HaveTheSurfacesOfTheReference) {
  const std::vector<GaussianPixel> truth = DrawGaussians(gaussians_, view_);
  for (const kernels::SimdLevel& level : kernels::SimdLevels()) {
    SCOPED_TRACE(level.name);
    const kernels::WithSimdLevel use(level);
    GaussianRenderer renderer;
    renderer.Draw(camera_, {3, blocks_});
    const GaussianSurface surface = renderer.FindSurface(camera_, {3, blocks_});
    int compared = 0, with_median = 0, other_median = 0;
    for (std::size_t p = 0; p < truth.size(); ++p) {
      if (truth[p].median_distance > 0) ++with_median;
      // Where rounding takes the light below half at another Gaussian.
      if (std::abs(surface.median_distance[p] - truth[p].median_distance) > 1e-4) ++other_median;
      if (truth[p].normal.norm() < 1e-2) continue;
      ++compared;
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(surface.normal[p][k], truth[p].normal.normalized()[k], 5e-3);
      }
    }
    EXPECT_GT(compared, 300);
    EXPECT_GT(with_median, 50);
    EXPECT_LE(other_median, 2);
  }
}

TEST_P(GaussiansOfEveryLens, HaveTheGradientsOfTheReference) {
  const int rows = kernels::GaussianRows(3);
  // By central differences, once for all levels.
  std::vector<double> truth;
  std::vector<double> scale_of_row(rows, 0.0);
  for (Gaussian& g : gaussians_) {
    for (int row = 0; row < rows; ++row) {
      double& value = RowOf(g, row);
      const double before = value;
      truth.push_back(CentralDifference([&](double step) {
        value = before + step;
        return LossOf(gaussians_, view_);
      }));
      value = before;
      scale_of_row[row] = std::max(scale_of_row[row], std::abs(truth.back()));
    }
  }
  std::vector<double> pose;
  for (int k = 0; k < 6; ++k) {
    pose.push_back(CentralDifference([&](double step) {
      GaussianView moved = view_;
      Eigen::Isometry3d by = Eigen::Isometry3d::Identity();
      if (k < 3) by.rotate(Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(k)));
      if (k >= 3) by.translation() = step * Eigen::Vector3d::Unit(k - 3);
      moved.camera_from_normalized = by * view_.camera_from_normalized;
      return LossOf(gaussians_, moved);
    }));
  }
  for (const kernels::SimdLevel& level : kernels::SimdLevels()) {
    SCOPED_TRACE(level.name);
    const kernels::WithSimdLevel use(level);
    GaussianRenderer renderer;
    const Gradients found = GradientsOf(renderer, view_, {3, blocks_});
    for (std::size_t i = 0; i < gaussians_.size(); ++i) {
      for (int row = 0; row < rows; ++row) {
        const double value = found.parameters[(i / 16 * rows + row) * 16 + i % 16];
        EXPECT_NEAR(value, truth[i * rows + row], 2e-3 * scale_of_row[row])
            << "Gaussian " << i << ", row " << row;
      }
    }
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(found.pose.turned[k], pose[k], 2e-3 * std::abs(pose[k]) + 0.05);
      EXPECT_NEAR(found.pose.moved[k], pose[3 + k], 2e-3 * std::abs(pose[3 + k]) + 0.05);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lenses, GaussiansOfEveryLens, testing::Range(0, kNumCameraModels),
                         [](const auto& test) {
                           return std::string(
                               CameraModelName(static_cast<CameraModel>(test.param)));
                         });

}  // namespace
}  // namespace nerf
