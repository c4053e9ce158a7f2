#include "nerf/render/libtorch_engine.h"

#include <algorithm>
#include <cmath>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/effects/anti_aliasing.h"
#include "nerf/effects/depth_supervision.h"
#include "nerf/field/background.h"
#include "nerf/field/exposure.h"
#include "nerf/field/pose_refinement.h"
#include "nerf/field/tensor_span.h"
#include "nerf/kernels/volume_rendering.h"
#include "nerf/render/describe_non_finite.h"
#include "nerf/render/losses.h"
#include "nerf/render/non_finite_error.h"
#include "nerf/render/proposal_sampling.h"
#include "nerf/render/ray_gradient.h"
#include "nerf/render/volume_rendering.h"

namespace nerf {
namespace {

// Samples per evaluation of the field where no gradients are needed: bounds memory, and keeps
// intermediate results close to the cache.
constexpr std::int64_t kChunk = 1 << 15;

// Scales the gradients of the field's outputs; see GradientScalingOptions.
void ScaleGradients(const FieldOutput& field, const torch::Tensor& t, double full_distance) {
  if (full_distance == 0 || !field.sigma.requires_grad()) return;
  const torch::Tensor scale = torch::clamp((t / full_distance).square(), 0.0, 1.0);
  field.sigma.register_hook([scale](const torch::Tensor& g) { return g * scale; });
  field.radiance.register_hook([scale](const torch::Tensor& g) { return g * scale.unsqueeze(1); });
}

}  // namespace

struct LibTorchEngine::Evaluated {
  PackedSamples samples;
  std::int64_t marched = 0;
  ProposedSamples proposed;  // where there is a proposal
  FieldOutput field;
  VolumeRendering pixels;
};

// The footprints of the samples; empty without anti-aliasing.
std::vector<float> LibTorchEngine::FootprintsOf(const RayBatch& rays,
                                                const PackedSamples& samples) const {
  if (!Effects().anti_aliasing) return {};
  return Footprints(rays, samples.ray, samples.t, *Effects().anti_aliasing);
}

torch::Tensor LibTorchEngine::AntiAliasingWeightsOf(std::span<const float> footprint) const {
  const kernels::HashGridLayout& layout = parts_.field->Hash().Layout();
  const std::vector<float> weights = AntiAliasingWeights(layout, footprint);
  return TensorOf(weights,
                  {static_cast<std::int64_t>(footprint.size()),
                   static_cast<std::int64_t>(layout.levels.size())},
                  parts_.field->Dtype())
      .clone();
}

// Densities without gradients, in chunks.
//   footprint  [S] or empty
std::vector<float> LibTorchEngine::Densities(std::span<const float> positions,
                                             std::span<const float> footprint, double detail,
                                             DensityFunction density) const {
  const torch::NoGradGuard no_grad;
  const auto size = static_cast<std::int64_t>(positions.size() / 3);
  std::vector<float> sigma(size);
  for (std::int64_t first = 0; first < size; first += kChunk) {
    const std::int64_t count = std::min(kChunk, size - first);
    const torch::Tensor chunk =
        torch::from_blob(const_cast<float*>(&positions[3 * first]), {count, 3})
            .to(parts_.field->Dtype());
    const torch::Tensor level_weights =
        footprint.empty() ? torch::Tensor()
                          : AntiAliasingWeightsOf(footprint.subspan(first, count));
    const torch::Tensor part =
        (parts_.field.get()->*density)(chunk, level_weights, detail).to(torch::kFloat).contiguous();
    std::copy_n(part.data_ptr<float>(), count, sigma.begin() + first);
  }
  return sigma;
}

// The samples in front of the point where a ray's transmittance falls below the bound, found from
// densities without gradients. Colour and gradients are computed only for these.
PackedSamples LibTorchEngine::VisibleSamples(const RayBatch& rays, const PackedSamples& samples,
                                             double detail) const {
  const std::vector<float> sigma =
      Densities(samples.position, FootprintsOf(rays, samples), detail, &RadianceField::Density);
  std::vector<std::int64_t> kept(samples.Rays());
  ParallelFor(samples.Rays(), 64, [&](std::int64_t first, std::int64_t last) {
    kernels::CountVisible<float>(samples.ray_begin, sigma, samples.dt,
                                 parts_.config.march.stop_transmittance, kept, first, last);
  });
  return KeepFront(samples, kept);
}

// The background of each ray, [R,3].
torch::Tensor LibTorchEngine::BackgroundOf(const RayBatch& rays) const {
  const torch::Dtype dtype = parts_.field->Dtype();
  return parts_.background
             ? parts_.background->forward(TensorOf(rays.direction, {rays.Size(), 3}, dtype))
             : TensorOf(rays.background, {rays.Size(), 3}, dtype);
}

// The same for training: a fixed background, behind photographs with alpha, has no exposure.
torch::Tensor LibTorchEngine::TrainingBackground(
    const RayBatch& rays, const std::vector<std::int64_t>& photograph) const {
  if (!parts_.exposure || parts_.background) return BackgroundOf(rays);
  return parts_.exposure->DivideByGains(BackgroundOf(rays),
                                        TensorOf(photograph, {rays.Size()}, torch::kLong));
}

// The forward pass, from rays to pixels.
//   background  [R,3]
//   refined     the rays as differentiable tensors, for pose refinement; or null
LibTorchEngine::Evaluated LibTorchEngine::Evaluate(const RayBatch& rays,
                                                   const torch::Tensor& background,
                                                   const RefinedRays* refined,
                                                   const Annealing& annealing) const {
  const torch::Dtype dtype = parts_.field->Dtype();
  Evaluated out;
  PackedSamples placed;
  if (parts_.proposal) {
    out.proposed = ProposeSamples(rays, *parts_.proposal, parts_.config.proposal,
                                  parts_.config.march, annealing.proposal);
    placed = out.proposed.samples;
  } else {
    placed = MarchRays(rays, *parts_.grid, parts_.config.march);
  }
  out.marched = placed.Size();
  out.samples = VisibleSamples(rays, placed, annealing.detail);

  const std::int64_t count = rays.Size();
  const std::int64_t size = out.samples.Size();
  const torch::Tensor directions = TensorOf(rays.direction, {count, 3}, dtype);
  const torch::Tensor ray = TensorOf(out.samples.ray, {size}, torch::kLong);
  const torch::Tensor t = TensorOf(out.samples.t, {size}, dtype);
  torch::Tensor positions = TensorOf(out.samples.position, {size, 3}, dtype);
  if (refined) {
    // Bit for bit the positions of the samples, with the gradient by the refined rays.
    const torch::Tensor moving = SamplePositions(refined->origin, refined->direction, ray, t);
    positions = positions + (moving - moving.detach());
  }
  const std::vector<float> footprint = FootprintsOf(rays, out.samples);
  out.field = parts_.field->forward(
      positions, directions, ray,
      footprint.empty() ? torch::Tensor() : AntiAliasingWeightsOf(footprint), annealing.detail);
  ScaleGradients(out.field, t, parts_.config.gradient_scaling.full_distance);

  out.pixels =
      RenderVolume(TensorOf(out.samples.ray_begin, {count + 1}, torch::kLong), out.field.sigma,
                   out.field.radiance, TensorOf(out.samples.dt, {size}, dtype), t, background);
  return out;
}

RenderOutput LibTorchEngine::Render(const RayBatch& rays) const {
  const torch::NoGradGuard no_grad;
  CheckRays(rays);
  const Evaluated out = Evaluate(rays, BackgroundOf(rays), nullptr, parts_.annealing);
  const auto to_vector = [](const torch::Tensor& tensor) {
    const torch::Tensor flat = tensor.to(torch::kFloat).contiguous();
    return std::vector<float>(flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel());
  };
  RenderOutput result = {to_vector(out.pixels.rgb),
                         to_vector(out.pixels.opacity),
                         to_vector(out.pixels.depth),
                         out.marched + out.samples.Size(),
                         {}};
  for (std::size_t r = 0; r < result.depth.size(); ++r) {
    if (result.opacity[r] > 0) {
      result.depth[r] = std::clamp(result.depth[r] / result.opacity[r],
                                   static_cast<float>(parts_.config.march.near_distance),
                                   static_cast<float>(parts_.config.march.far_distance));
    }
  }
  return result;
}

// The loss of nerf/effects/depth_supervision.h: the samples' costs are composited like a colour,
// in front of a background of cost 1.
torch::Tensor LibTorchEngine::DepthLoss(const TargetBatch& batch, const Evaluated& out) const {
  const torch::Dtype dtype = parts_.field->Dtype();
  const std::int64_t count = batch.rays.Size(), size = out.samples.Size();
  const std::vector<float> costs =
      DepthCosts(out.samples.t, out.samples.ray, batch.distance, *Effects().depth_supervision);
  const torch::Tensor of_sample = TensorOf(costs, {size, 1}, dtype).expand({size, 3}).clone();
  const torch::Tensor of_background =
      (TensorOf(batch.distance, {count, 1}, dtype) > 0).to(dtype).expand({count, 3}).clone();
  const torch::Tensor cost =
      RenderVolume(TensorOf(out.samples.ray_begin, {count + 1}, torch::kLong), out.field.sigma,
                   of_sample, TensorOf(out.samples.dt, {size}, dtype),
                   TensorOf(out.samples.t, {size}, dtype), of_background)
          .rgb;
  return Effects().depth_supervision->weight * cost.mean();
}

StepResult LibTorchEngine::AccumulateGradients(const TargetBatch& batch,
                                               const StepContext& context) {
  if (batch.rays.Size() == 0) return {};  // the mean over no rays is NaN
  const torch::Dtype dtype = parts_.field->Dtype();
  const std::int64_t count = batch.rays.Size();
  CheckRays(batch.rays);
  Evaluated out;
  RayBatch refined_batch;  // must live until the end of the backward pass
  const auto photograph = [&] { return TensorOf(batch.photograph, {count}, torch::kLong); };
  if (parts_.pose_refinement) {
    const RefinedRays refined = parts_.pose_refinement->forward(
        TensorOf(batch.rays.origin, {count, 3}, dtype),
        TensorOf(batch.rays.direction, {count, 3}, dtype), photograph());
    refined_batch = WithRefinedRays(batch.rays, refined);
    out = Evaluate(refined_batch, TrainingBackground(refined_batch, batch.photograph), &refined,
                   context.annealing);
  } else {
    out = Evaluate(batch.rays, TrainingBackground(batch.rays, batch.photograph), nullptr,
                   context.annealing);
  }
  const torch::Tensor target = TensorOf(batch.rgb, {count, 3}, out.pixels.rgb.scalar_type());
  torch::Tensor rgb = out.pixels.rgb;
  if (parts_.exposure) rgb = parts_.exposure->forward(rgb, photograph(), target);
  std::optional<RobustOptions> robust;
  if (Effects().robust) robust = Effects().robust->At(context.progress);
  torch::Tensor loss = ColorLoss(rgb, target, parts_.config.loss, robust);
  if (Effects().depth_supervision && !batch.distance.empty()) loss = loss + DepthLoss(batch, out);
  StepResult result;
  result.loss = loss.item<double>();
  if (!std::isfinite(result.loss)) {
    throw NonFiniteError("the loss is not finite: " +
                         DescribeNonFinite(out.samples, out.field, rgb, target));
  }
  torch::Tensor total = loss;
  if (parts_.proposal) {
    total = loss + ProposalLoss(out.proposed, out.samples, out.field.sigma, parts_.config.proposal,
                                parts_.config.march);
  }
  // A batch without any samples depends on no parameter.
  if (total.requires_grad()) total.backward();
  torch::Tensor of_ray = (rgb.detach() - target).square().mean(1);
  result.squared_error = of_ray.mean().item<double>();
  if (robust) of_ray = of_ray * RobustRayWeights(rgb, target, parts_.config.loss, *robust);
  of_ray = of_ray.to(torch::kFloat).contiguous();
  const auto ray_error = Span<const float>(of_ray);
  result.ray_error.assign(ray_error.begin(), ray_error.end());
  result.marched = out.marched;
  result.shaded = out.samples.Size();
  return result;
}

void LibTorchEngine::UpdateOccupancy(const StepContext& context) {
  if (parts_.proposal) return;
  parts_.grid->Update(context.step, context.seed, [&](std::span<const float> positions) {
    return Densities(positions, {}, context.annealing.detail, &RadianceField::ContractedDensity);
  });
}

}  // namespace nerf
