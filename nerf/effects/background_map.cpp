#include "nerf/effects/background_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nerf/kernels/activations.h"

namespace nerf {
namespace {

// As the field's TruncatedExp clamps its argument.
constexpr float kExpLimit = 15.0f;

}  // namespace

BackgroundMap::Texels BackgroundMap::TexelsOf(std::span<const float, 3> direction, int rows) {
  const double x = direction[0], y = direction[1];
  const double z = std::clamp(static_cast<double>(direction[2]), -1.0, 1.0);
  const int columns = 2 * rows;
  const double longitude = std::atan2(y, x) / (2 * std::numbers::pi) + 0.5;
  const double u = longitude * columns - 0.5;
  const double v = std::clamp(std::acos(z) / std::numbers::pi * rows - 0.5, 0.0, rows - 1.0);
  const double left = std::floor(u), top = std::min(std::floor(v), rows - 2.0);
  const auto across = static_cast<float>(u - left), down = static_cast<float>(v - top);
  // Longitude wraps around: the first column follows the last.
  const auto column = static_cast<std::int64_t>(left);
  const std::int64_t columns_of[2] = {(column + columns) % columns, (column + 1) % columns};
  Texels texels;
  for (int k = 0; k < 4; ++k) {
    const int right = k & 1, below = k >> 1;
    texels.index[k] = (static_cast<std::int64_t>(top) + below) * columns + columns_of[right];
    texels.weight[k] = (right ? across : 1 - across) * (below ? down : 1 - down);
  }
  return texels;
}

void BackgroundMap::Radiance(std::span<const float> direction, std::span<float> rgb) const {
  for (std::size_t r = 0; r < direction.size() / 3; ++r) {
    const Texels texels = TexelsOf(direction.subspan(3 * r).first<3>(), rows);
    for (int c = 0; c < 3; ++c) {
      float sum = 0;
      for (int k = 0; k < 4; ++k) sum += texels.weight[k] * raw[3 * texels.index[k] + c];
      rgb[3 * r + c] = sum;
    }
  }
  if (encoding == ColorEncoding::kSrgb) {
    kernels::Sigmoid(rgb);
  } else {
    kernels::TruncatedExp(rgb, 0.0f, kExpLimit);
  }
}

void BackgroundMap::AddGradient(std::span<const float, 3> direction, std::span<const float, 3> rgb,
                                std::span<const float, 3> dL_drgb, std::span<float> dL_draw) const {
  const Texels texels = TexelsOf(direction, rows);
  for (int c = 0; c < 3; ++c) {
    const float slope = encoding == ColorEncoding::kSrgb ? rgb[c] * (1 - rgb[c]) : rgb[c];
    for (int k = 0; k < 4; ++k) {
      dL_draw[3 * texels.index[k] + c] += texels.weight[k] * slope * dL_drgb[c];
    }
  }
}

}  // namespace nerf
