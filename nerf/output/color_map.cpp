#include "nerf/output/color_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/quantile.h"
#include "nerf/image/image_convert.h"

namespace nerf {
namespace {

constexpr float kGrey = 0.5f;
constexpr float kMostlyOpaque = 0.5f;

void CheckSameSize(const Image& a, const Image& b) {
  if (a.width == b.width && a.height == b.height) return;
  throw InputError("images of {} x {} and {} x {} pixels cannot be compared", a.width, a.height,
                   b.width, b.height);
}

struct Range {
  float near = 0;
  float far = 1;
};

Range RangeOfOpaqueDepths(const Image& depth, const Image& opacity) {
  std::vector<float> depths;
  for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
    if (opacity.pixels[i] > kMostlyOpaque && std::isfinite(depth.pixels[i])) {
      depths.push_back(depth.pixels[i]);
    }
  }
  if (depths.empty()) return {};
  const float near = Quantile(depths, 0.02);
  return {near, Quantile(depths, 0.98)};
}

void Store(const Eigen::Vector3f& color, float* pixel) { std::copy_n(color.data(), 3, pixel); }

}  // namespace

Eigen::Vector3f Turbo(float value) {
  const float x = std::clamp(value, 0.0f, 1.0f);
  Eigen::Matrix<float, 3, 6> coefficients;
  coefficients << 0.13572138f, 4.61539260f, -42.66032258f, 132.13108234f, -152.94239396f,
      59.28637943f,                                                                    // red
      0.09140261f, 2.19418839f, 4.84296658f, -14.18503333f, 4.27729857f, 2.82956604f,  // green
      0.10667330f, 12.64194608f, -60.58204836f, 110.36276771f, -89.90310912f, 27.34824973f;  // blue
  Eigen::Vector<float, 6> powers;
  powers << 1, x, x * x, x * x * x, x * x * x * x, x * x * x * x * x;
  return (coefficients * powers).cwiseMax(0.0f).cwiseMin(1.0f);
}

Eigen::Vector3f Heat(float value) {
  const Eigen::Vector3f ramps(3 * value, 3 * value - 1, 3 * value - 2);
  return ramps.cwiseMax(0.0f).cwiseMin(1.0f);
}

Image ColorizeDepth(const Image& depth, const Image& opacity) {
  CheckSameSize(depth, opacity);
  const Range range = RangeOfOpaqueDepths(depth, opacity);
  const float span = std::max(range.far - range.near, 1e-12f);
  Image colors(depth.width, depth.height, 3);
  for (int y = 0; y < depth.height; ++y) {
    for (int x = 0; x < depth.width; ++x) {
      const float d = *depth.At(x, y);
      const float alpha = std::isfinite(d) ? *opacity.At(x, y) : 0.0f;
      const Eigen::Vector3f color =
          alpha > 0 ? Turbo((range.far - d) / span) : Eigen::Vector3f::Zero();
      Store(alpha * color + Eigen::Vector3f::Constant((1 - alpha) * kGrey), colors.At(x, y));
    }
  }
  return colors;
}

Image ColorizeError(const Image& a, const Image& b) {
  CheckSameSize(a, b);
  const Image a_on_white = OnWhite(a);
  const Image b_on_white = OnWhite(b);
  Image colors(a.width, a.height, 3);
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const Eigen::Map<const Eigen::Vector3f> color_a(a_on_white.At(x, y));
      const Eigen::Map<const Eigen::Vector3f> color_b(b_on_white.At(x, y));
      Store(Heat((color_a - color_b).cwiseAbs().mean() / kWhiteError), colors.At(x, y));
    }
  }
  return colors;
}

}  // namespace nerf
