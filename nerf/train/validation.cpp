#include "nerf/train/validation.h"

#include <algorithm>
#include <array>
#include <map>
#include <span>

#include "nerf/effects/exposure_fit.h"
#include "nerf/effects/poses.h"
#include "nerf/field/tensor_span.h"
#include "nerf/train/engine.h"
#include "nerf/train/model.h"
#include "nerf/train/tally.h"

namespace nerf {
namespace {

constexpr std::int64_t kRays = 8192;

void FitToPhotographs(std::span<float> rgb, const TargetBatch& truth, ColorEncoding encoding) {
  std::map<std::int64_t, std::vector<std::size_t>> rays_of;
  for (std::size_t r = 0; r < truth.photograph.size(); ++r) {
    rays_of[truth.photograph[r]].push_back(r);
  }
  for (const auto& [photograph, rays] : rays_of) {
    std::vector<float> rendered, shown;
    for (const std::size_t r : rays) {
      rendered.insert(rendered.end(), &rgb[3 * r], &rgb[3 * r] + 3);
      shown.insert(shown.end(), &truth.rgb[3 * r], &truth.rgb[3 * r] + 3);
    }
    const std::array<float, 3> gains = FitGains(rendered, shown, encoding);
    for (const std::size_t r : rays) ApplyGains(gains, rgb.subspan(3 * r, 3));
  }
}

}  // namespace

Validation::Validation(const std::vector<View>& views, std::uint64_t seed) {
  if (views.empty()) return;
  batch_ = PixelSampler(views).Sample(kRays, seed, 0);
  std::ranges::fill(batch_.rays.jitter, 0.5f);
  for (const std::int64_t photograph : batch_.photograph) {
    const View& view = views[photograph];
    const Eigen::Vector3f axis = view.normalized_from_camera.linear().col(2).cast<float>();
    axis_.insert(axis_.end(), axis.begin(), axis.end());
    lens_.push_back(view.lens);
  }
}

// As refined focal lengths have them; the poses of these photographs are as they were given.
RayBatch Validation::Rays(const Model& model) const {
  if (!model.poses) return batch_.rays;
  const torch::NoGradGuard no_grad;
  const std::int64_t count = batch_.rays.Size();
  const torch::Tensor of_lens = model.poses->LogFocals();
  std::vector<float> log_f;
  for (const std::int64_t lens : lens_) {
    log_f.push_back(lens < of_lens.size(0) ? of_lens[lens].item<float>() : 0.0f);
  }
  const auto rows = [&](const std::vector<float>& values) {
    return TensorOf(values, {count, 3}, torch::kFloat);
  };
  return Poses::WithMoved(batch_.rays, {rows(batch_.rays.origin),
                                        Poses::Zoomed(rows(batch_.rays.direction), rows(axis_),
                                                      TensorOf(log_f, {count, 1}, torch::kFloat))});
}

double Validation::Psnr(const Model& model, bool fit_exposure) const {
  RenderOutput out = model.engine->Render(Rays(model));
  if (fit_exposure) FitToPhotographs(out.rgb, batch_, model.scene.encoding);
  double sum = 0;
  for (std::size_t i = 0; i < out.rgb.size(); ++i) {
    const double error = std::clamp(out.rgb[i], 0.0f, 1.0f) - std::clamp(batch_.rgb[i], 0.0f, 1.0f);
    sum += error * error;
  }
  return PsnrOf(sum / static_cast<double>(out.rgb.size()));
}

}  // namespace nerf
