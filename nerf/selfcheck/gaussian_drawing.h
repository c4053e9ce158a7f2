#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "nerf/reference/gaussians.h"
#include "nerf/selfcheck/gaussian_scene.h"
#include "nerf/selfcheck/numeric_case.h"
#include "nerf/splats/gaussian_camera.h"
#include "nerf/splats/gaussian_renderer.h"

// What the cases of Gaussians draw, and how they look at it.
namespace nerf::gaussian_drawing {

using reference::Gaussian;
using reference::GaussianView;

inline constexpr double kFocal = 60;

inline GaussianView SmallView(CameraModel model = CameraModel::kPinhole) {
  const bool is_fisheye = model == CameraModel::kOpenCVFisheye;
  return {{model, 48, 40,
           is_fisheye ? std::vector<double>{30, 30, 24, 20, 0.01, 0, 0, 0}
                      : std::vector<double>{kFocal, kFocal, 24, 20}},
          Eigen::Isometry3d::Identity(),
          0.02};
}

// A grey one on the axis.
inline Gaussian At(double distance, double size, double opacity = 2) {
  Gaussian g;
  g.mean = Eigen::Vector3d(0, 0, distance);
  g.log_scale = Eigen::Vector3d::Constant(std::log(size));
  g.opacity = opacity;
  g.color = {Eigen::Vector3d(0.3, -0.2, 0.5)};
  return g;
}

// What is drawn, and the gradients of the sum of all its values.
struct Drawn {
  GaussianPicture picture;
  std::vector<float> gradients;
  double alpha = 0;  // sum over the pixels of 1 - transmittance
};

inline Drawn Draw(const std::vector<Gaussian>& gaussians, const GaussianView& view) {
  const std::vector<float> blocks = InBlocks(gaussians, 0);
  const GaussianParameters parameters{0, blocks};
  const kernels::GaussianCamera camera =
      MakeGaussianCamera(view.camera, view.camera_from_normalized.inverse(), view.near);
  GaussianRenderer renderer;
  Drawn drawn{renderer.Draw(camera, parameters), std::vector<float>(blocks.size(), 0.0f), 0};
  GaussianPicture ones = drawn.picture;
  std::ranges::fill(ones.values, 1.0f);
  renderer.Backward(camera, parameters, ones, false,
                    [&](std::int64_t block, std::span<float> of_block, std::span<const float>) {
                      std::ranges::copy(of_block,
                                        drawn.gradients.begin() +
                                            block * static_cast<std::ptrdiff_t>(of_block.size()));
                    });
  for (int y = 0; y < drawn.picture.height; ++y) {
    for (int x = 0; x < drawn.picture.width; ++x) {
      drawn.alpha += 1 - static_cast<double>(drawn.picture.Plane(
                             GaussianPicture::kTransmittance)[y * drawn.picture.stride + x]);
    }
  }
  return drawn;
}

// The largest difference of colours and transmittance from the reference.
inline double Difference(const Drawn& drawn, const std::vector<Gaussian>& gaussians,
                         const GaussianView& view) {
  WorstError worst;
  const auto truth = DrawGaussians(gaussians, view);
  for (int y = 0; y < drawn.picture.height; ++y) {
    for (int x = 0; x < drawn.picture.width; ++x) {
      const reference::GaussianPixel& pixel =
          truth[static_cast<std::size_t>(y) * drawn.picture.width + x];
      const auto at = [&](int plane) -> double {
        return drawn.picture.Plane(plane)[y * drawn.picture.stride + x];
      };
      for (int c = 0; c < 3; ++c) worst.Add(at(c) - pixel.rgb[c]);
      worst.Add(at(GaussianPicture::kTransmittance) - pixel.transmittance);
    }
  }
  return worst.Get();
}

inline void RequireFinite(const Drawn& drawn, WorstError& worst) {
  for (const float value : drawn.gradients) worst.RequireFinite(value);
  for (int plane = 0; plane < GaussianPicture::kPlanes; ++plane) {
    for (int y = 0; y < drawn.picture.height; ++y) {
      for (int x = 0; x < drawn.picture.width; ++x) {
        worst.RequireFinite(drawn.picture.Plane(plane)[y * drawn.picture.stride + x]);
      }
    }
  }
}

}  // namespace nerf::gaussian_drawing
