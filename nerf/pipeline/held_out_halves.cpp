#include "nerf/pipeline/held_out_halves.h"

#include <algorithm>

#include "nerf/scene/camera.h"

namespace nerf {
namespace {

constexpr std::size_t kMaxHalves = 8, kOneIn = 4;

}  // namespace

View ColumnsOf(const View& view, int left, int right) {
  const std::int64_t all = view.camera.width, width = right - left;
  // The index in the part of a pixel of the whole; -1 if it is outside.
  const auto index_in_part = [&](std::int64_t pixel) {
    const std::int64_t column = pixel % all - left;
    return column >= 0 && column < width ? pixel / all * width + column : -1;
  };
  View part;
  part.name = view.name;
  part.camera = CropColumns(view.camera, left, right - left);
  part.normalized_from_camera = view.normalized_from_camera;
  part.lens = view.lens;
  part.seed = view.seed;
  const auto share = static_cast<std::size_t>(view.StoredCount() * width / all + 1);
  part.valid_pixels.reserve(share);
  part.rgba.reserve(4 * share);
  for (std::int64_t k = 0; k < view.StoredCount(); ++k) {
    const std::int64_t pixel = index_in_part(view.PixelIndex(k));
    if (pixel < 0) continue;
    part.valid_pixels.push_back(static_cast<std::uint32_t>(pixel));
    part.rgba.insert(part.rgba.end(), &view.rgba[4 * k], &view.rgba[4 * k] + 4);
  }
  for (const DepthObservation& point : view.depth_observations) {
    const std::int64_t pixel = index_in_part(point.pixel);
    if (pixel >= 0) part.depth_observations.push_back({pixel, point.distance});
  }
  return part;
}

HeldOutHalves::HeldOutHalves(Dataset& data) : data_(data) {
  validation_.swap(data.validation);
  const std::size_t all = data.train.size(), count = std::min(kMaxHalves, all / kOneIn);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t index = (2 * k + 1) * all / (2 * count);
    View& view = data.train[index];
    const int width = view.camera.width;
    View left = ColumnsOf(view, 0, width / 2), right = ColumnsOf(view, width / 2, width);
    if (left.StoredCount() == 0 || right.StoredCount() == 0) continue;
    data.validation.push_back(std::move(right));
    wholes_.emplace_back(index, std::exchange(view, std::move(left)));
  }
}

HeldOutHalves::~HeldOutHalves() {
  for (auto& [index, whole] : wholes_) data_.train[index] = std::move(whole);
  data_.validation = std::move(validation_);
}

}  // namespace nerf
