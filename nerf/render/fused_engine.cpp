#include "nerf/render/fused_engine.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/stopwatch.h"
#include "nerf/field/background.h"
#include "nerf/field/exposure.h"
#include "nerf/field/poses.h"
#include "nerf/field/tensor_span.h"
#include "nerf/render/background_rays.h"
#include "nerf/render/fused_worker.h"
#include "nerf/render/ray_gradient.h"
#include "nerf/sampling/occupancy_grid.h"

namespace nerf {
namespace {

// Positions whose density is asked for at once, without rays.
constexpr std::int64_t kTilePositions = 512;

}  // namespace

FusedEngine::FusedEngine(EngineParts parts) : parts_(std::move(parts)), forward_(parts_) {
  pixel_model_.loss = parts_.loss;
  pixel_model_.robust = parts_.robust;
  if (parts_.exposure) {
    pixel_model_.saturates = parts_.exposure->Saturates();
    pixel_model_.unexposed = !parts_.background;
  }
}

FusedEngine::~FusedEngine() = default;

void FusedEngine::SetProgress(double progress) {
  if (parts_.robust) pixel_model_.robust = parts_.robust->At(progress);
}

void FusedEngine::Refresh() {
  forward_.Refresh();
  if (parts_.background) background_ = parts_.background->Map();
  if (parts_.exposure) {
    const torch::NoGradGuard no_grad;
    const torch::Tensor gains = parts_.exposure->Gains().contiguous();
    const auto values = Span<const float>(gains);
    pixel_model_.gain.assign(values.begin(), values.end());
  }
}

RenderOutput FusedEngine::Render(const RayBatch& rays) {
  CheckRays(rays);
  Refresh();
  return parts_.background ? RenderRays(WithBackground(rays, background_)) : RenderRays(rays);
}

RenderOutput FusedEngine::RenderRays(const RayBatch& rays) const {
  const std::int64_t count = rays.Size();
  RenderOutput out;
  out.rgb.resize(3 * count);
  out.opacity.resize(count);
  out.depth.resize(count);
  const auto near = static_cast<float>(parts_.march.near_distance);
  const auto far = static_cast<float>(parts_.march.far_distance);
  std::atomic<std::int64_t> samples = 0;
  std::mutex adding;
  // Neighbouring rays share cells; chunks are small enough to keep all threads at work to the end.
  constexpr std::int64_t kChunk = 256;
  ParallelForEach((count + kChunk - 1) / kChunk, [&](std::int64_t chunk) {
    FusedTile tile;
    LapTimer timer;
    const std::int64_t last = std::min(count, (chunk + 1) * kChunk);
    for (std::int64_t first = chunk * kChunk; first < last;) {
      const std::int64_t next = forward_.Run(rays, first, last, tile);
      std::copy(tile.rgb.begin(), tile.rgb.end(), out.rgb.begin() + 3 * first);
      std::copy(tile.opacity.begin(), tile.opacity.end(), out.opacity.begin() + first);
      for (std::int64_t r = first; r < next; ++r) {
        const float opacity = tile.opacity[r - first], depth = tile.depth[r - first];
        out.depth[r] = opacity > 0 ? std::clamp(depth / opacity, near, far) : depth;
      }
      first = next;
    }
    samples += tile.placed;
    double all = 0;
    timer.Lap(all);
    const std::lock_guard lock(adding);
    out.seconds.Add(tile.Seconds(all), 1.0 / NumThreads());
  });
  out.samples = samples;
  return out;
}

StepResult FusedEngine::AccumulateGradients(const TargetBatch& batch) {
  CheckRays(batch.rays);
  Refresh();
  if (!parts_.background && !parts_.poses && !parts_.exposure) return LearnFrom(batch);
  TargetBatch seen =
      pixel_model_.unexposed ? WithUnexposedBackgrounds(batch, pixel_model_.gain) : batch;
  const std::int64_t count = batch.rays.Size();
  Poses::Moved moved;
  if (parts_.poses) {
    moved = parts_.poses->forward(TensorOf(batch.rays.origin, {count, 3}, torch::kFloat),
                                  TensorOf(batch.rays.direction, {count, 3}, torch::kFloat),
                                  TensorOf(batch.photograph, {count}, torch::kLong));
    seen.rays = Poses::WithMoved(batch.rays, moved);
  }
  if (parts_.background) seen.rays = WithBackground(seen.rays, background_);
  const StepResult result = LearnFrom(seen);
  if (parts_.poses) {
    const RayGradient gradient = GradientOfRays(seen.rays);
    torch::autograd::backward({moved.origin, moved.direction},
                              {TensorOf(gradient.origin, {count, 3}, torch::kFloat).clone(),
                               TensorOf(gradient.direction, {count, 3}, torch::kFloat).clone()});
  }
  return result;
}

// What the samples of the batch that was learned from pass on to its rays.
RayGradient FusedEngine::GradientOfRays(const RayBatch& rays) const {
  RayGradient gradient = {std::vector<float>(rays.origin.size(), 0.0f),
                          std::vector<float>(rays.direction.size(), 0.0f)};
  // Each worker's rays are its own.
  ParallelForEach(static_cast<std::int64_t>(workers_.size()), [&](std::int64_t k) {
    const Worker& worker = workers_[k];
    std::vector<float> dL_dposition(3 * worker.t.size(), 0.0f);
    forward_.Field().Density().AddToPositions(worker.field.density, dL_dposition);
    AddToRays(rays, worker.ray, worker.t, dL_dposition, worker.dL_dlog_sigma, gradient);
  });
  return gradient;
}

StepResult FusedEngine::LearnFrom(const TargetBatch& batch) {
  const std::int64_t count = batch.rays.Size();
  // A fixed share of the rays for each thread, so that sums repeat bit for bit.
  const auto threads = static_cast<std::int64_t>(NumThreads());
  workers_.resize(threads);
  StepResult result;
  result.ray_error.resize(count);
  ParallelFor(threads, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      Worker& worker = workers_[k];
      worker.pixels.Clear(pixel_model_);
      worker.background.assign(background_.raw.size(), 0.0f);
      worker.ray.clear();
      worker.t.clear();
      worker.dL_dlog_sigma.clear();
      worker.tile.placed = worker.tile.shaded = 0;
      worker.tile.sampling_seconds = 0;
      worker.tile.field.density.seconds = {};
      LapTimer timer;
      forward_.Field().Clear(worker.field);
      if (forward_.Proposal()) forward_.Proposal()->Clear(worker.proposal);
      const std::int64_t last = count * (k + 1) / threads;
      for (std::int64_t first = count * k / threads; first < last;) {
        const std::int64_t next = forward_.Run(batch.rays, first, last, worker.tile);
        Backward(batch, first, worker, result.ray_error);
        first = next;
      }
      double all = 0;
      timer.Lap(all);
      worker.seconds = worker.tile.Seconds(all);
    }
  });

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
    result.seconds.Add(worker.seconds, 1.0 / static_cast<double>(threads));
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
  const double channels = 3.0 * static_cast<double>(std::max<std::int64_t>(1, count));
  result.loss /= channels;
  result.squared_error /= channels;
  return result;
}

void FusedEngine::UpdateOccupancy(std::int64_t step, std::uint64_t seed) {
  if (parts_.proposal) return;
  Refresh();
  parts_.grid->Update(step, seed, [this](std::span<const float> positions) {
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
