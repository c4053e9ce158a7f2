#include "nerf/render/pixel_loss.h"

#include <array>
#include <cmath>

namespace nerf {
namespace {

// Loss of one colour channel and its derivative, as ColorLoss defines them.
struct ChannelLoss {
  double value, derivative;
};
ChannelLoss LossOf(double error, const LossOptions& options) {
  if (options.kind == LossKind::kMse) return {error * error, 2 * error};
  const double size = std::fabs(error), delta = options.huber_delta;
  if (size <= delta) return {0.5 * error * error / delta, error / delta};
  return {size - 0.5 * delta, error > 0 ? 1.0 : -1.0};
}

}  // namespace

TargetBatch WithUnexposedBackgrounds(TargetBatch batch, std::span<const float> gain) {
  for (std::int64_t r = 0; r < batch.rays.Size(); ++r) {
    for (int c = 0; c < 3; ++c) {
      batch.rays.background[3 * r + c] /= gain[3 * batch.photograph[r] + c];
    }
  }
  return batch;
}

void PixelLoss::Clear(const PixelModel& model) {
  loss = squared_error = 0;
  dL_dlog_gain.assign(model.gain.size(), 0.0);
}

bool PixelLoss::Add(const PixelModel& model, const TargetBatch& batch, std::int64_t first,
                    std::span<const float> rgb, std::span<const float> opacity,
                    std::span<float> ray_error) {
  const auto count = static_cast<std::int64_t>(rgb.size() / 3);
  const double channels = 3.0 * static_cast<double>(batch.rays.Size());
  dL_drgb.resize(3 * count);
  dL_dopacity.assign(count, 0.0f);
  dL_ddepth.assign(count, 0.0f);
  double of_tile = 0;
  for (std::int64_t r = 0; r < count; ++r) {
    const std::int64_t photograph = model.gain.empty() ? 0 : 3 * batch.photograph[first + r];
    const float* const gain = model.gain.empty() ? nullptr : &model.gain[photograph];
    double squared = 0, of_ray = 0;
    std::array<double, 3> shown{}, dL_dshown{};
    for (int c = 0; c < 3; ++c) {
      const float target = batch.rgb[3 * (first + r) + c];
      shown[c] = static_cast<double>(gain ? gain[c] * rgb[3 * r + c] : rgb[3 * r + c]);
      // A clipped pixel may be brighter than its value.
      const bool clipped = gain && model.saturates && target >= 1 && shown[c] > 1;
      const double error = clipped ? 0.0 : shown[c] - static_cast<double>(target);
      const ChannelLoss of_channel = LossOf(error, model.loss);
      of_ray += of_channel.value;
      squared += error * error;
      dL_dshown[c] = of_channel.derivative / channels;
    }
    double weight = 1;  // of the ray's gradients
    if (model.robust) {
      const double mean = of_ray / 3;
      of_ray = 3 * RobustLoss(mean, *model.robust);
      weight = RobustWeight(mean, *model.robust);
    }
    for (int c = 0; c < 3; ++c) {
      dL_drgb[3 * r + c] =
          static_cast<float>(weight * dL_dshown[c] * static_cast<double>(gain ? gain[c] : 1.0f));
      if (!gain) continue;
      double exposed = shown[c];  // without the fixed background, which has no exposure
      if (model.unexposed) {
        exposed -= static_cast<double>(gain[c] * (1 - opacity[r]) *
                                       batch.rays.background[3 * (first + r) + c]);
      }
      dL_dlog_gain[photograph + c] += weight * dL_dshown[c] * exposed;
    }
    of_tile += of_ray;
    squared_error += squared;
    ray_error[first + r] = static_cast<float>(weight * squared / 3);
  }
  loss += of_tile;
  return std::isfinite(of_tile);
}

}  // namespace nerf
