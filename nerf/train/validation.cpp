#include "nerf/train/validation.h"

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "nerf/effects/exposure_fit.h"
#include "nerf/field/pose_refinement.h"
#include "nerf/field/tensor_span.h"
#include "nerf/model/model.h"
#include "nerf/render/view_renderer.h"
#include "nerf/train/step_statistics.h"

namespace nerf {
namespace {

constexpr std::int64_t kRays = 8192;

// Brings each photograph's rays to its exposure.
void FitExposures(RenderOutput& out, const TargetBatch& truth, ColorEncoding encoding) {
  std::map<std::int64_t, std::vector<std::size_t>> rays_of;
  for (std::size_t r = 0; r < truth.photograph.size(); ++r) {
    rays_of[truth.photograph[r]].push_back(r);
  }
  for (const auto& [photograph, rays] : rays_of) {
    std::vector<float> rendered, shown, background, opacity;
    const auto append = [](std::size_t r, const std::vector<float>& from, std::vector<float>& to) {
      to.insert(to.end(), &from[3 * r], &from[3 * r] + 3);
    };
    for (const std::size_t r : rays) {
      append(r, out.rgb, rendered);
      append(r, truth.rgb, shown);
      append(r, truth.rays.background, background);
      opacity.push_back(out.opacity[r]);
    }
    FitExposure(rendered, opacity, shown, background, encoding);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      std::copy_n(&rendered[3 * k], 3, &out.rgb[3 * rays[k]]);
    }
  }
}

}  // namespace

Validation::Validation(const std::vector<View>& views, std::uint64_t seed) {
  if (views.empty()) return;
  for (const View& view : views) names_.push_back(view.name);
  batch_ = PixelSampler(views).Sample(kRays, seed, 0);
  std::ranges::fill(batch_.rays.jitter, 0.5f);
  for (const std::int64_t photograph : batch_.photograph) {
    const View& view = views[photograph];
    const Eigen::Vector3f axis = view.normalized_from_camera.linear().col(2).cast<float>();
    axis_.insert(axis_.end(), axis.begin(), axis.end());
    lens_.push_back(view.lens);
  }
}

// The rays with refined focal lengths, and with refined poses where a part of the photograph was
// trained on.
RayBatch Validation::Rays(const Model& model) const {
  if (!model.pose_refinement) return batch_.rays;
  const torch::NoGradGuard no_grad;
  const std::int64_t count = batch_.rays.Size();
  const torch::Tensor of_lens = model.pose_refinement->LogFocals();
  const std::vector<std::string>& trained = model.scene.photographs;
  // Of each view, its index among the training photographs; nullopt if it is not one.
  std::vector<std::optional<std::int64_t>> index_of;
  for (const std::string& name : names_) {
    const auto found = std::ranges::find(trained, name);
    index_of.emplace_back(found == trained.end() ? std::nullopt
                                                 : std::optional(found - trained.begin()));
  }
  std::vector<float> log_f, trained_on;
  std::vector<std::int64_t> index;
  for (std::int64_t r = 0; r < count; ++r) {
    log_f.push_back(lens_[r] < of_lens.size(0) ? of_lens[lens_[r]].item<float>() : 0.0f);
    const std::optional<std::int64_t> of_photograph = index_of[batch_.photograph[r]];
    trained_on.push_back(of_photograph ? 1.0f : 0.0f);
    index.push_back(of_photograph.value_or(0));
  }
  const auto rows = [&](const std::vector<float>& values, std::int64_t columns) {
    return TensorOf(values, {count, columns}, torch::kFloat);
  };
  const torch::Tensor origin = rows(batch_.rays.origin, 3);
  const torch::Tensor direction = rows(batch_.rays.direction, 3);
  const RefinedRays refined =
      model.pose_refinement->forward(origin, direction, TensorOf(index, {count}, torch::kLong));
  const torch::Tensor scaled =
      PoseRefinement::ScaleFocalLength(direction, rows(axis_, 3), rows(log_f, 1));
  const torch::Tensor has_pose = rows(trained_on, 1) > 0.5;
  return WithRefinedRays(batch_.rays, {torch::where(has_pose, refined.origin, origin),
                                       torch::where(has_pose, refined.direction, scaled)});
}

double Validation::Psnr(const Model& model, bool fit_exposure) const {
  return Psnr(MakeRenderer(model)->Render(Rays(model)), fit_exposure, model.scene.encoding);
}

double Validation::Psnr(RenderOutput out, bool fit_exposure, ColorEncoding encoding) const {
  if (fit_exposure) FitExposures(out, batch_, encoding);
  std::vector<double> error(names_.size(), 0.0);
  std::vector<std::int64_t> values(names_.size(), 0);
  for (std::size_t i = 0; i < out.rgb.size(); ++i) {
    const double difference =
        std::clamp(out.rgb[i], 0.0f, 1.0f) - std::clamp(batch_.rgb[i], 0.0f, 1.0f);
    const std::int64_t photograph = batch_.photograph[i / 3];
    error[photograph] += difference * difference;
    ++values[photograph];
  }
  double sum = 0;
  int photographs = 0;
  for (std::size_t k = 0; k < error.size(); ++k) {
    if (values[k] == 0) continue;
    sum += PsnrFromMse(error[k] / static_cast<double>(values[k]));
    ++photographs;
  }
  return sum / photographs;
}

}  // namespace nerf
