// FusedEngine's backward pass, from the pixels of a tile to the gradients accumulated by its
// thread.
#include <algorithm>

#include "nerf/base/stopwatch.h"
#include "nerf/effects/depth_supervision.h"
#include "nerf/kernels/volume_rendering.h"
#include "nerf/render/fused_worker.h"
#include "nerf/render/non_finite_error.h"

namespace nerf {

// The loss of nerf/effects/depth_supervision.h. Its gradient is that of an expected depth in which
// the samples' costs replace their distances; no other loss uses the gradient of depth.
void FusedEngine::AddDepthLoss(const TargetBatch& batch, std::int64_t first, Worker& worker) const {
  const FusedTile& tile = worker.tile;
  const std::int64_t count = tile.Rays(), size = tile.samples.Size();
  const double weight = parts_.config.effects.depth_supervision->weight;
  const auto dL_dcost = static_cast<float>(weight / static_cast<double>(batch.rays.Size()));
  worker.costs = DepthCosts(tile.samples.t, tile.ray, batch.distance,
                            *parts_.config.effects.depth_supervision);
  worker.weights.resize(size);
  kernels::WeightsForward<float>(tile.ray_begin, tile.field.density.sigma, tile.samples.dt,
                                 worker.weights, 0, count);
  for (std::int64_t r = 0; r < count; ++r) {
    if (batch.distance[first + r] == 0) continue;
    auto cost = static_cast<double>(1 - tile.opacity[r]);
    for (std::int64_t i = tile.ray_begin[r]; i < tile.ray_begin[r + 1]; ++i) {
      cost += static_cast<double>(worker.weights[i] * worker.costs[i]);
    }
    worker.pixels.loss += 3 * weight * cost;  // the sum is over rays and channels
    worker.pixels.dL_ddepth[r] = dL_dcost;
    worker.pixels.dL_dopacity[r] = -dL_dcost;
  }
}

// Backward pass of a tile.
void FusedEngine::Backward(const TargetBatch& batch, std::int64_t first, Worker& worker,
                           std::span<float> ray_error) const {
  FusedTile& tile = worker.tile;
  LapTimer timer;
  const std::int64_t count = tile.Rays(), size = tile.samples.Size();
  if (!worker.pixels.Add(pixel_model_, batch, first, tile.rgb, tile.opacity, ray_error)) {
    throw NonFiniteError(
        "the loss is not finite: " +
        DescribeNonFinite(tile, std::span(batch.rgb).subspan(3 * first, 3 * count), first));
  }
  kernels::RaySegments<float> segments = tile.Segments(batch.rays, first);
  if (parts_.config.effects.depth_supervision && !batch.distance.empty()) {
    AddDepthLoss(batch, first, worker);
    segments.t = worker.costs;
  }
  worker.dL_dbackground.resize(3 * count);
  worker.dL_dsigma.resize(size);
  worker.dL_dradiance.resize(3 * size);
  kernels::CompositeBackward<float>(
      segments, {worker.pixels.dL_drgb, worker.pixels.dL_dopacity, worker.pixels.dL_ddepth},
      {worker.dL_dsigma, worker.dL_dradiance, worker.dL_dbackground}, 0, count);
  if (parts_.background) {
    for (std::int64_t r = 0; r < count; ++r) {
      const auto of_ray = [r](std::span<const float> values, std::int64_t from) {
        return values.subspan(3 * (from + r)).first<3>();
      };
      background_.AddGradient(of_ray(batch.rays.direction, first),
                              of_ray(batch.rays.background, first),
                              of_ray(worker.dL_dbackground, 0), worker.background);
    }
  }
  timer.Lap(tile.compositing_seconds);
  if (forward_.Proposal()) {
    forward_.Proposal()->Backward(batch.rays.Size(), tile.ray_begin, tile.field.density.sigma,
                                  tile.samples.dt, tile.proposal, worker.dL_dsigma,
                                  worker.proposal);
    timer.Lap(tile.sampling_seconds);
  }
  if (const double full = parts_.config.gradient_scaling.full_distance; full > 0) {
    for (std::int64_t i = 0; i < size; ++i) {
      const double distance = static_cast<double>(tile.samples.t[i]) / full;
      const auto scale = static_cast<float>(std::min(1.0, distance * distance));
      worker.dL_dsigma[i] *= scale;
      for (int c = 0; c < 3; ++c) worker.dL_dradiance[3 * i + c] *= scale;
    }
  }
  if (parts_.pose_refinement) {
    worker.ray.insert(worker.ray.end(), tile.ray.begin(), tile.ray.begin() + size);
    worker.t.insert(worker.t.end(), tile.samples.t.begin(), tile.samples.t.begin() + size);
    for (std::int64_t i = 0; i < size; ++i) {
      worker.dL_dlog_sigma.push_back(worker.dL_dsigma[i] * tile.field.density.sigma[i]);
    }
  }
  forward_.Field().Backward(size, tile.samples.position, worker.dL_dsigma, worker.dL_dradiance,
                            tile.field, worker.field);
}

}  // namespace nerf
