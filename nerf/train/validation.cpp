#include "nerf/train/validation.h"

#include <algorithm>
#include <map>
#include <vector>

#include "nerf/effects/exposure_fit.h"
#include "nerf/effects/poses.h"
#include "nerf/field/tensor_span.h"
#include "nerf/train/engine.h"
#include "nerf/train/model.h"
#include "nerf/train/tally.h"

namespace nerf {
namespace {

constexpr std::int64_t kRays = 8192;

void FitToPhotographs(RenderOutput& out, const TargetBatch& truth, ColorEncoding encoding) {
  std::map<std::int64_t, std::vector<std::size_t>> rays_of;
  for (std::size_t r = 0; r < truth.photograph.size(); ++r) {
    rays_of[truth.photograph[r]].push_back(r);
  }
  const std::vector<float> all_through = SeenThrough(out.opacity, truth.rays.background);
  for (const auto& [photograph, rays] : rays_of) {
    std::vector<float> rendered, shown, through;
    const auto take = [](std::size_t r, const std::vector<float>& from, std::vector<float>& to) {
      to.insert(to.end(), &from[3 * r], &from[3 * r] + 3);
    };
    for (const std::size_t r : rays) {
      take(r, out.rgb, rendered);
      take(r, truth.rgb, shown);
      take(r, all_through, through);
    }
    ApplyGains(FitGains(rendered, shown, through, encoding), through, rendered);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      std::copy_n(&rendered[3 * k], 3, &out.rgb[3 * rays[k]]);
    }
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
  if (fit_exposure) FitToPhotographs(out, batch_, model.scene.encoding);
  double sum = 0;
  for (std::size_t i = 0; i < out.rgb.size(); ++i) {
    const double error = std::clamp(out.rgb[i], 0.0f, 1.0f) - std::clamp(batch_.rgb[i], 0.0f, 1.0f);
    sum += error * error;
  }
  return PsnrOf(sum / static_cast<double>(out.rgb.size()));
}

}  // namespace nerf
