#include "nerf/render/fused_engine.h"

#include <algorithm>

#include "nerf/base/parallel.h"
#include "nerf/base/stopwatch.h"
#include "nerf/field/background.h"
#include "nerf/field/exposure.h"
#include "nerf/field/pose_refinement.h"
#include "nerf/field/tensor_span.h"
#include "nerf/render/background_rays.h"
#include "nerf/render/fused_renderer.h"
#include "nerf/render/fused_worker.h"
#include "nerf/render/ray_gradient.h"
#include "nerf/sampling/occupancy_grid.h"

namespace nerf {
namespace {

// Positions per tile when the occupancy grid is updated.
constexpr std::int64_t kTilePositions = 512;

}  // namespace

FusedEngine::FusedEngine(const ModelParts& parts) : parts_(parts), forward_(parts) {
  pixel_model_.loss = parts.config.loss;
  if (parts.exposure) {
    pixel_model_.saturates = parts.exposure->Saturates();
    pixel_model_.unexposed = !parts.background;
  }
}

FusedEngine::~FusedEngine() = default;

RenderOutput FusedEngine::Render(const RayBatch& rays) const {
  return FusedRenderer(parts_).Render(rays);
}

// Copies the parameters, which the optimiser changes between batches, and applies the context.
void FusedEngine::Refresh(const StepContext& context) {
  forward_.Refresh(context.annealing);
  if (const auto& robust = parts_.config.effects.robust) {
    pixel_model_.robust = robust->At(context.progress);
  }
  if (parts_.background) background_ = parts_.background->Map();
  if (parts_.exposure) {
    const torch::NoGradGuard no_grad;
    const torch::Tensor gains = parts_.exposure->Gains().contiguous();
    const auto values = Span<const float>(gains);
    pixel_model_.gain.assign(values.begin(), values.end());
  }
}

StepResult FusedEngine::AccumulateGradients(const TargetBatch& batch, const StepContext& context) {
  CheckRays(batch.rays);
  Refresh(context);
  if (!parts_.background && !parts_.pose_refinement && !parts_.exposure) return RunBatch(batch);
  TargetBatch effective =
      pixel_model_.unexposed ? WithUnexposedBackgrounds(batch, pixel_model_.gain) : batch;
  const std::int64_t count = batch.rays.Size();
  RefinedRays refined;
  if (parts_.pose_refinement) {
    refined =
        parts_.pose_refinement->forward(TensorOf(batch.rays.origin, {count, 3}, torch::kFloat),
                                        TensorOf(batch.rays.direction, {count, 3}, torch::kFloat),
                                        TensorOf(batch.photograph, {count}, torch::kLong));
    effective.rays = WithRefinedRays(batch.rays, refined);
  }
  if (parts_.background) effective.rays = WithBackground(effective.rays, background_);
  const StepResult result = RunBatch(effective);
  if (parts_.pose_refinement) {
    const RayGradient gradient = GradientOfRays(effective.rays);
    torch::autograd::backward({refined.origin, refined.direction},
                              {TensorOf(gradient.origin, {count, 3}, torch::kFloat).clone(),
                               TensorOf(gradient.direction, {count, 3}, torch::kFloat).clone()});
  }
  return result;
}

// dL/dray of the batch of the last RunBatch, from the gradients of its samples.
RayGradient FusedEngine::GradientOfRays(const RayBatch& rays) const {
  RayGradient gradient = {std::vector<float>(rays.origin.size(), 0.0f),
                          std::vector<float>(rays.direction.size(), 0.0f)};
  // No ray is shared between workers.
  ParallelForEach(static_cast<std::int64_t>(workers_.size()), [&](std::int64_t k) {
    const Worker& worker = workers_[k];
    std::vector<float> dL_dposition(3 * worker.t.size(), 0.0f);
    forward_.Field().Density().AddToPositions(worker.field.density, dL_dposition);
    AddToRays(rays, worker.ray, worker.t, dL_dposition, worker.dL_dlog_sigma, gradient);
  });
  return gradient;
}

// Forward and backward pass of the rays [first, last), by one thread.
void FusedEngine::RunShare(const TargetBatch& batch, std::int64_t first, std::int64_t last,
                           Worker& worker, std::span<float> ray_error) {
  worker.pixels.Clear(pixel_model_);
  worker.background.assign(background_.raw.size(), 0.0f);
  worker.ray.clear();
  worker.t.clear();
  worker.dL_dlog_sigma.clear();
  worker.tile.placed = worker.tile.shaded = 0;
  worker.tile.sampling_seconds = worker.tile.compositing_seconds = 0;
  worker.tile.field.density.seconds = {};
  forward_.Field().Clear(worker.field);
  if (forward_.Proposal()) forward_.Proposal()->Clear(worker.proposal);
  while (first < last) {
    const std::int64_t next = forward_.Run(batch.rays, first, last, worker.tile);
    Backward(batch, first, worker, ray_error);
    first = next;
  }
  worker.seconds = worker.tile.Seconds();
}

// Forward and backward pass of a batch, by all threads.
StepResult FusedEngine::RunBatch(const TargetBatch& batch) {
  const std::int64_t count = batch.rays.Size();
  // Each thread has a fixed share of the rays, so that sums are the same bit for bit in every run.
  const auto threads = static_cast<std::int64_t>(NumThreads());
  workers_.resize(threads);
  std::vector<float> ray_error(count);
  ParallelFor(threads, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      RunShare(batch, count * k / threads, count * (k + 1) / threads, workers_[k], ray_error);
    }
  });
  StepResult result = ReduceWorkers(count);
  result.ray_error = std::move(ray_error);
  return result;
}

// Adds the workers' gradients, in their order, to those of the parameters.
StepResult FusedEngine::ReduceWorkers(std::int64_t rays) {
  StepResult result;
  std::vector<double> dL_dlog_gain(pixel_model_.gain.size(), 0.0);
  std::vector<float> dL_dmap(background_.raw.size(), 0.0f);
  std::vector<const FieldGradients*> of_field;
  std::vector<const DensityGradients*> of_proposal;
  for (const Worker& worker : workers_) {
    of_field.push_back(&worker.field);
    of_proposal.push_back(&worker.proposal);
    for (std::size_t i = 0; i < dL_dlog_gain.size(); ++i) {
      dL_dlog_gain[i] += worker.pixels.dL_dlog_gain[i];
    }
    for (std::size_t i = 0; i < dL_dmap.size(); ++i) dL_dmap[i] += worker.background[i];
    result.loss += worker.pixels.loss;
    result.squared_error += worker.pixels.squared_error;
    result.marched += worker.tile.placed;
    result.shaded += worker.tile.shaded;
    result.seconds.Add(worker.seconds, 1.0 / static_cast<double>(workers_.size()));
  }
  LapTimer timer;
  if (parts_.background) parts_.background->AddGradient(dL_dmap);
  if (parts_.exposure) parts_.exposure->AddGradient(dL_dlog_gain);
  forward_.Field().AddToParameters(of_field);
  timer.Lap(result.seconds.encoding);
  if (forward_.Proposal()) {
    forward_.Proposal()->AddToParameters(of_proposal);
    timer.Lap(result.seconds.sampling);
  }
  const double channels = 3.0 * static_cast<double>(std::max<std::int64_t>(1, rays));
  result.loss /= channels;
  result.squared_error /= channels;
  return result;
}

void FusedEngine::UpdateOccupancy(const StepContext& context) {
  if (parts_.proposal) return;
  Refresh(context);
  parts_.grid->Update(context.step, context.seed, [this](std::span<const float> positions) {
    const auto count = static_cast<std::int64_t>(positions.size() / 3);
    std::vector<float> sigma(count);
    ParallelFor(count, kTilePositions, [&](std::int64_t begin, std::int64_t end) {
      DensityTile tile;
      for (std::int64_t first = begin; first < end; first += kTilePositions) {
        const std::int64_t size = std::min(kTilePositions, end - first);
        forward_.Field().Density().ContractedDensity(positions.subspan(3 * first, 3 * size), tile);
        std::copy(tile.sigma.begin(), tile.sigma.end(), sigma.begin() + first);
      }
    });
    return sigma;
  });
}

}  // namespace nerf
