#include "nerf/splats/target_pictures.h"

#include <algorithm>
#include <cstdint>

#include "nerf/base/parallel.h"
#include "nerf/kernels/half_planes.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

constexpr std::int64_t kRowsTogether = 16;
// A pixel from which the camera says only that it is at least so bright. Where the exposure of the
// photograph is above the mean, other photographs know more.
constexpr float kClipped = 0.998f, kWeightOfClipped = 0.1f;

// Where all pixels are stored, row after row.
void FillRows(const View& photograph, const std::array<float, 4>& scale, TargetPicture& target) {
  static_assert(sizeof(Eigen::half) == sizeof(std::uint16_t));
  const auto* const bits = reinterpret_cast<const std::uint16_t*>(photograph.rgba.data());
  const std::size_t values = 4 * static_cast<std::size_t>(target.width);
  ParallelFor(target.height, kRowsTogether, [&](std::int64_t first, std::int64_t last) {
    for (auto y = static_cast<int>(first); y < last; ++y) {
      kernels::PlanesOfHalves(
          {bits + static_cast<std::size_t>(y) * values, values}, scale,
          {target.Row(0, y), target.Row(1, y), target.Row(2, y), target.Row(3, y)});
      std::fill_n(target.Row(TargetPicture::kWeight, y), target.width, 1.0f);
    }
  });
}

void FillStored(const View& photograph, const std::array<float, 4>& scale, TargetPicture& target) {
  for (std::int64_t k = 0; k < photograph.StoredCount(); ++k) {
    const std::int64_t pixel = photograph.PixelIndex(k);
    const auto y = static_cast<int>(pixel / target.width),
               x = static_cast<int>(pixel % target.width);
    for (int plane = 0; plane < 4; ++plane) {
      target.Row(plane, y)[x] = static_cast<float>(photograph.rgba[4 * k + plane]) * scale[plane];
    }
    target.Row(TargetPicture::kWeight, y)[x] = 1;
  }
}

// Which pixels are clipped in some channel whose gain is above 1: [height][width]; empty: none is.
std::vector<char> ClippedPixels(const std::array<float, 3>& gains, const TargetPicture& target) {
  if (std::ranges::none_of(gains, [](float gain) { return gain > 1; })) return {};
  std::vector<char> clipped(static_cast<std::size_t>(target.width) * target.height);
  ParallelFor(target.height, kRowsTogether, [&](std::int64_t first, std::int64_t last) {
    for (auto y = static_cast<int>(first); y < last; ++y) {
      const float* const opacity = target.Row(TargetPicture::kOpacity, y);
      for (int c = 0; c < 3; ++c) {
        if (gains[c] <= 1) continue;
        const float* const values = target.Row(c, y);
        for (int x = 0; x < target.width; ++x) {
          const bool is_clipped = opacity[x] > 0 && values[x] * gains[c] > kClipped;
          if (is_clipped) clipped[static_cast<std::size_t>(y) * target.width + x] = 1;
        }
      }
    }
  });
  return clipped;
}

// Where one of the pixels that were averaged is clipped, so is their mean.
void WeighClipped(const std::vector<char>& clipped, int width, int halvings,
                  TargetPicture& target) {
  const int side = 1 << halvings;
  for (int y = 0; y < target.height; ++y) {
    float* const weight = target.Row(TargetPicture::kWeight, y);
    for (int x = 0; x < target.width; ++x) {
      bool any = false;
      for (int v = y * side; v < (y + 1) * side && !any; ++v) {
        const char* const row = &clipped[static_cast<std::size_t>(v) * width];
        any = std::any_of(row + x * side, row + (x + 1) * side, [](char is) { return is != 0; });
      }
      if (any) weight[x] = std::min(weight[x], kWeightOfClipped);
    }
  }
}

}  // namespace

std::vector<TargetView> TargetViewsOf(const std::vector<View>& views) {
  std::vector<TargetView> targets;
  for (const View& view : views) {
    targets.push_back({&view, view.camera, view.normalized_from_camera});
  }
  return targets;
}

TargetPicture TargetOf(const TargetView& view) {
  TargetPicture target;
  MakeTarget(view, target);
  return target;
}

void MakeTarget(const TargetView& view, TargetPicture& target) {
  const View& photograph = *view.photograph;
  target.Resize(photograph.camera.width, photograph.camera.height);
  const std::array<float, 4> scale = {1 / view.gains[0], 1 / view.gains[1], 1 / view.gains[2], 1};
  if (photograph.StoredCount() == PixelCount(photograph.camera)) {
    FillRows(photograph, scale, target);
  } else {
    FillStored(photograph, scale, target);
  }
  const std::vector<char> clipped = ClippedPixels(view.gains, target);
  for (int i = 0; i < view.halvings; ++i) target = Halved(target);
  if (!clipped.empty()) WeighClipped(clipped, photograph.camera.width, view.halvings, target);
}

TargetView Reduced(TargetView view, int halvings) {
  view.camera = Downscaled(view.camera, 1 << halvings);
  view.halvings += halvings;
  return view;
}

}  // namespace nerf
