#include "nerf/render/libtorch_engine.h"

#include <algorithm>
#include <cmath>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/effects/depth.h"
#include "nerf/effects/footprint.h"
#include "nerf/field/background.h"
#include "nerf/field/exposure.h"
#include "nerf/field/poses.h"
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

// Samples a single evaluation of the field takes when no gradients are needed: intermediate results
// then stay near the cache, and memory bounded.
constexpr std::int64_t kChunk = 1 << 15;

// Scales what reaches the field's outputs on the way back; forward nothing changes.
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

LibTorchEngine::LibTorchEngine(EngineParts parts)
    : parts_(std::move(parts)), robust_(parts_.robust) {}

void LibTorchEngine::SetProgress(double progress) {
  if (parts_.robust) robust_ = parts_.robust->At(progress);
}

// The patches that samples stand for; empty where they are points.
std::vector<float> LibTorchEngine::FootprintsOf(const RayBatch& rays,
                                                const PackedSamples& samples) const {
  if (!parts_.footprint) return {};
  return Footprints(rays, samples.ray, samples.t, *parts_.footprint);
}

torch::Tensor LibTorchEngine::SharesOf(std::span<const float> footprint) const {
  const kernels::HashGridLayout& layout = parts_.field->Hash().Layout();
  const std::vector<float> shares = LevelShares(layout, footprint);
  return TensorOf(shares,
                  {static_cast<std::int64_t>(footprint.size()),
                   static_cast<std::int64_t>(layout.levels.size())},
                  parts_.field->Dtype())
      .clone();
}

// Densities without gradients, a chunk of positions at a time.
//   footprint  [S], as FootprintOptions has it; or empty
std::vector<float> LibTorchEngine::Densities(std::span<const float> positions,
                                             std::span<const float> footprint,
                                             DensityFunction density) {
  const torch::NoGradGuard no_grad;
  const auto size = static_cast<std::int64_t>(positions.size() / 3);
  std::vector<float> sigma(size);
  for (std::int64_t first = 0; first < size; first += kChunk) {
    const std::int64_t count = std::min(kChunk, size - first);
    const torch::Tensor chunk =
        torch::from_blob(const_cast<float*>(&positions[3 * first]), {count, 3})
            .to(parts_.field->Dtype());
    const torch::Tensor shares =
        footprint.empty() ? torch::Tensor() : SharesOf(footprint.subspan(first, count));
    const torch::Tensor part =
        (parts_.field.get()->*density)(chunk, shares).to(torch::kFloat).contiguous();
    std::copy_n(part.data_ptr<float>(), count, sigma.begin() + first);
  }
  return sigma;
}

// The samples in front of the point where a ray's transmittance falls below the bound: found from
// densities alone and without gradients, so that colour and gradients are computed for no other.
PackedSamples LibTorchEngine::VisibleSamples(const RayBatch& rays, const PackedSamples& samples) {
  const std::vector<float> sigma =
      Densities(samples.position, FootprintsOf(rays, samples), &RadianceField::Density);
  std::vector<std::int64_t> kept(samples.Rays());
  ParallelFor(samples.Rays(), 64, [&](std::int64_t first, std::int64_t last) {
    kernels::CountVisible<float>(samples.ray_begin, sigma, samples.dt,
                                 parts_.march.stop_transmittance, kept, first, last);
  });
  return KeepFront(samples, kept);
}

// What rays see where they meet nothing, [R,3].
torch::Tensor LibTorchEngine::Behind(const RayBatch& rays) const {
  const torch::Dtype dtype = parts_.field->Dtype();
  return parts_.background
             ? parts_.background->forward(TensorOf(rays.direction, {rays.Size(), 3}, dtype))
             : TensorOf(rays.background, {rays.Size(), 3}, dtype);
}

// A ray's way from its origin to its pixel.
//   behind  [R,3] what it sees where it meets nothing
//   moved   the rays as refined poses have them, for gradients; null: constants
LibTorchEngine::Evaluated LibTorchEngine::Evaluate(const RayBatch& rays,
                                                   const torch::Tensor& behind,
                                                   const Poses::Moved* moved) {
  const torch::Dtype dtype = parts_.field->Dtype();
  Evaluated out;
  PackedSamples placed;
  if (parts_.proposal) {
    out.proposed = ProposeSamples(rays, *parts_.proposal, parts_.proposal_options, parts_.march);
    placed = out.proposed.samples;
  } else {
    placed = MarchRays(rays, *parts_.grid, parts_.march);
  }
  out.marched = placed.Size();
  out.samples = VisibleSamples(rays, placed);

  const std::int64_t count = rays.Size();
  const std::int64_t size = out.samples.Size();
  const torch::Tensor directions = TensorOf(rays.direction, {count, 3}, dtype);
  const torch::Tensor ray = TensorOf(out.samples.ray, {size}, torch::kLong);
  const torch::Tensor t = TensorOf(out.samples.t, {size}, dtype);
  torch::Tensor positions = TensorOf(out.samples.position, {size, 3}, dtype);
  if (moved) {
    // The value to the last bit as samples have it, the gradient of how they came to stand there.
    const torch::Tensor moving = SamplePositions(moved->origin, moved->direction, ray, t);
    positions = positions + (moving - moving.detach());
  }
  const std::vector<float> footprint = FootprintsOf(rays, out.samples);
  out.field = parts_.field->forward(positions, directions, ray,
                                    footprint.empty() ? torch::Tensor() : SharesOf(footprint));
  ScaleGradients(out.field, t, parts_.gradient_scaling.full_distance);

  out.pixels =
      RenderVolume(TensorOf(out.samples.ray_begin, {count + 1}, torch::kLong), out.field.sigma,
                   out.field.radiance, TensorOf(out.samples.dt, {size}, dtype), t, behind);
  return out;
}

RenderOutput LibTorchEngine::Render(const RayBatch& rays) {
  const torch::NoGradGuard no_grad;
  CheckRays(rays);
  const Evaluated out = Evaluate(rays, Behind(rays), nullptr);
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
                                   static_cast<float>(parts_.march.near_distance),
                                   static_cast<float>(parts_.march.far_distance));
    }
  }
  return result;
}

// As nerf/effects/depth.h defines it: what the samples cost is rendered like a colour, before the
// cost of seeing nothing.
torch::Tensor LibTorchEngine::DepthLoss(const TargetBatch& batch, const Evaluated& out) const {
  const torch::Dtype dtype = parts_.field->Dtype();
  const std::int64_t count = batch.rays.Size(), size = out.samples.Size();
  const std::vector<float> costs =
      CostsOfSamples(out.samples.t, out.samples.ray, batch.distance, *parts_.depth);
  const torch::Tensor of_sample = TensorOf(costs, {size, 1}, dtype).expand({size, 3}).clone();
  const torch::Tensor of_nothing =
      (TensorOf(batch.distance, {count, 1}, dtype) > 0).to(dtype).expand({count, 3}).clone();
  const torch::Tensor paid =
      RenderVolume(TensorOf(out.samples.ray_begin, {count + 1}, torch::kLong), out.field.sigma,
                   of_sample, TensorOf(out.samples.dt, {size}, dtype),
                   TensorOf(out.samples.t, {size}, dtype), of_nothing)
          .rgb;
  return parts_.depth->weight * paid.mean();
}

StepResult LibTorchEngine::AccumulateGradients(const TargetBatch& batch) {
  if (batch.rays.Size() == 0) return {};  // the mean over nothing is no number
  const torch::Dtype dtype = parts_.field->Dtype();
  const std::int64_t count = batch.rays.Size();
  CheckRays(batch.rays);
  Evaluated out;
  RayBatch refined;  // autograd reads it until the way back is over
  const auto photograph = [&] { return TensorOf(batch.photograph, {count}, torch::kLong); };
  const auto behind = [&](const RayBatch& rays) {
    const bool exposes = parts_.exposure && !parts_.background;
    return exposes ? parts_.exposure->Unexposed(Behind(rays), photograph()) : Behind(rays);
  };
  if (parts_.poses) {
    const Poses::Moved moved =
        parts_.poses->forward(TensorOf(batch.rays.origin, {count, 3}, dtype),
                              TensorOf(batch.rays.direction, {count, 3}, dtype), photograph());
    refined = Poses::WithMoved(batch.rays, moved);
    out = Evaluate(refined, behind(refined), &moved);
  } else {
    out = Evaluate(batch.rays, behind(batch.rays), nullptr);
  }
  const torch::Tensor target =
      TensorOf(batch.rgb, {batch.rays.Size(), 3}, out.pixels.rgb.scalar_type());
  torch::Tensor rgb = out.pixels.rgb;
  if (parts_.exposure) {
    rgb = parts_.exposure->forward(rgb, photograph(), target);
  }
  torch::Tensor loss = ColorLoss(rgb, target, parts_.loss, robust_);
  if (parts_.depth && !batch.distance.empty()) {
    loss = loss + DepthLoss(batch, out);
  }
  StepResult result;
  result.loss = loss.item<double>();
  if (!std::isfinite(result.loss)) {
    throw NonFiniteError("the loss is not finite: " +
                         DescribeNonFinite(out.samples, out.field, rgb, target));
  }
  torch::Tensor total = loss;
  if (parts_.proposal) {
    total = loss + ProposalLoss(out.proposed, out.samples, out.field.sigma, parts_.proposal_options,
                                parts_.march);
  }
  // A batch whose rays meet no occupied cell has no parameters to blame.
  if (total.requires_grad()) total.backward();
  torch::Tensor of_ray = (rgb.detach() - target).square().mean(1);
  result.squared_error = of_ray.mean().item<double>();
  if (robust_) of_ray = of_ray * PullOfRays(rgb, target, parts_.loss, *robust_);
  of_ray = of_ray.to(torch::kFloat).contiguous();
  const auto ray_error = Span<const float>(of_ray);
  result.ray_error.assign(ray_error.begin(), ray_error.end());
  result.marched = out.marched;
  result.shaded = out.samples.Size();
  return result;
}

void LibTorchEngine::UpdateOccupancy(std::int64_t step, std::uint64_t seed) {
  if (parts_.proposal) return;
  parts_.grid->Update(step, seed, [this](std::span<const float> positions) {
    return Densities(positions, {}, &RadianceField::ContractedDensity);
  });
}

}  // namespace nerf
