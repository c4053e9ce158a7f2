#include "nerf/scene/data_plan.h"

#include <Eigen/Core>
#include <algorithm>

#include "nerf/scene/camera.h"

namespace nerf {
namespace {

constexpr std::int64_t kBytesPerPixel = 4 * sizeof(Eigen::half);  // View::rgba

}  // namespace

std::int64_t DataPlan::Bytes() const { return stored_pixels * kBytesPerPixel; }

std::int64_t DataPlan::StoredPixelsOf(std::int64_t pixels_of_photograph) const {
  if (stored_pixels == pixels) return pixels_of_photograph;
  const double share = static_cast<double>(stored_pixels) / static_cast<double>(pixels);
  return std::max<std::int64_t>(
      1, static_cast<std::int64_t>(share * static_cast<double>(pixels_of_photograph)));
}

DataPlan PlanData(const PosedImages& posed, const DataOptions& options) {
  DataPlan plan;
  for (const PosedImage& image : posed.images) {
    if (image.split == Split::kTest) {
      ++plan.held_out;
      continue;
    }
    ++(image.split == Split::kValidation ? plan.validation : plan.train);
    plan.pixels += PixelCount(Downscaled(posed.cameras[image.camera], options.downscale));
  }
  const std::int64_t fit = (static_cast<std::int64_t>(options.memory_mb) << 20) / kBytesPerPixel;
  plan.stored_pixels = std::min(plan.pixels, fit);
  return plan;
}

}  // namespace nerf
