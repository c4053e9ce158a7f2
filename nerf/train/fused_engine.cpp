#include "nerf/train/fused_engine.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "nerf/kernels/volume_rendering.h"
#include "nerf/parallel.h"
#include "nerf/sampling/occupancy_grid.h"
#include "nerf/stopwatch.h"
#include "nerf/train/non_finite_error.h"
#include "sfm/input_error.h"

namespace nerf {
namespace {

// A tile takes rays until it has this many samples: their activations, a kilobyte each, then stay
// in a core's second-level cache.
constexpr std::int64_t kTileSamples = 256;

// Positions whose density is asked for at once, without rays.
constexpr std::int64_t kTilePositions = 512;

}  // namespace

// The rays of a tile on their way, and what the way back needs.
struct FusedEngine::Tile {
  ProposalTile proposal;
  RaySamples samples;
  std::vector<std::int64_t> ray_begin;  // [R+1]
  std::vector<std::int64_t> ray;        // [S] of the batch
  std::vector<std::int64_t> kept_of_ray, kept;
  FieldTile field;
  std::vector<float> rgb, opacity, depth;  // [R,3], [R], [R]
  std::int64_t placed = 0, shaded = 0;     // samples so far
  double sampling_seconds = 0;             // so far

  // Of a tile that has taken `all` seconds so far.
  StageSeconds Seconds(double all) const {
    StageSeconds seconds = field.density.seconds;
    seconds.sampling = sampling_seconds;
    seconds.SetAll(all);
    return seconds;
  }
  std::int64_t Rays() const { return static_cast<std::int64_t>(ray_begin.size()) - 1; }
  kernels::RaySegments<float> Segments(const RayBatch& rays, std::int64_t first) const {
    return {ray_begin,      field.density.sigma,
            samples.dt,     samples.t,
            field.radiance, std::span(rays.background).subspan(3 * first, 3 * Rays())};
  }
};

// What one thread keeps of its share of a batch.
struct FusedEngine::Worker {
  Tile tile;
  FieldGradients field;
  DensityGradients proposal;
  double loss = 0, squared_error = 0;  // sums over rays and channels
  StageSeconds seconds;                // of the thread
  std::vector<float> dL_drgb, dL_dopacity, dL_ddepth, dL_dsigma, dL_dradiance, dL_dbackground;
};

FusedEngine::FusedEngine(EngineParts parts)
    : parts_(std::move(parts)), field_(parts_.field, parts_.precision) {
  if (parts_.proposal) proposal_.emplace(parts_.proposal, parts_.proposal_options, parts_.march);
}

FusedEngine::~FusedEngine() = default;

void FusedEngine::Refresh() {
  field_.Refresh();
  if (proposal_) proposal_->Refresh();
}

// The samples of rays from `first` on, as many rays as fill a tile. Returns the first ray that is
// not in it.
std::int64_t FusedEngine::PlaceSamples(const RayBatch& rays, std::int64_t first, std::int64_t last,
                                       Tile& tile) const {
  tile.ray.clear();
  tile.ray_begin.assign(1, 0);
  std::int64_t end = first;
  if (proposal_) {
    const int each = proposal_->SamplesPerRay();
    end = std::min(last, first + std::max<std::int64_t>(1, kTileSamples / each));
    proposal_->Propose(rays, first, end, tile.proposal, tile.samples);
    for (std::int64_t r = first; r < end; ++r) {
      tile.ray.insert(tile.ray.end(), each, r);
      tile.ray_begin.push_back(static_cast<std::int64_t>(tile.ray.size()));
    }
    return end;
  }
  tile.samples.position.clear();
  tile.samples.t.clear();
  tile.samples.dt.clear();
  for (; end < last && tile.samples.Size() < kTileSamples; ++end) {
    MarchRay(rays, end, *parts_.grid, parts_.march, tile.samples);
    tile.ray.resize(tile.samples.Size(), end);
    tile.ray_begin.push_back(tile.samples.Size());
  }
  return end;
}

// Drops the samples behind the point where a ray's transmittance falls below the bound.
void FusedEngine::KeepVisible(Tile& tile) const {
  const std::int64_t rays = tile.Rays();
  tile.kept_of_ray.resize(rays);
  kernels::CountVisible<float>(tile.ray_begin, tile.field.density.sigma, tile.samples.dt,
                               parts_.march.stop_transmittance, tile.kept_of_ray, 0, rays);
  tile.kept.clear();
  std::int64_t begin = 0;
  for (std::int64_t r = 0; r < rays; ++r) {
    for (std::int64_t k = 0; k < tile.kept_of_ray[r]; ++k) tile.kept.push_back(begin + k);
    begin = tile.ray_begin[r + 1];
    tile.ray_begin[r + 1] = static_cast<std::int64_t>(tile.kept.size());
  }
  RaySamples& s = tile.samples;
  for (std::size_t to = 0; to < tile.kept.size(); ++to) {
    const std::int64_t from = tile.kept[to];
    s.t[to] = s.t[from];
    s.dt[to] = s.dt[from];
    tile.ray[to] = tile.ray[from];
    std::copy_n(&s.position[3 * from], 3, &s.position[3 * to]);
  }
  s.t.resize(tile.kept.size());
  s.dt.resize(tile.kept.size());
  s.position.resize(3 * tile.kept.size());
  tile.ray.resize(tile.kept.size());
  field_.Density().Keep(tile.kept, tile.field.density);
}

// The way of a tile of rays from their origins to their pixels.
std::int64_t FusedEngine::Forward(const RayBatch& rays, std::int64_t first, std::int64_t last,
                                  Tile& tile) const {
  LapTimer timer;
  const std::int64_t end = PlaceSamples(rays, first, last, tile);
  timer.Lap(tile.sampling_seconds);
  tile.placed += tile.samples.Size();
  field_.Density().Density(tile.samples.position, tile.field.density);
  KeepVisible(tile);
  tile.shaded += tile.samples.Size();
  field_.Radiance(tile.samples.Size(), tile.ray, rays.direction, tile.field);

  const std::int64_t count = tile.Rays();
  tile.rgb.resize(3 * count);
  tile.opacity.resize(count);
  tile.depth.resize(count);
  kernels::CompositeForward<float>(tile.Segments(rays, first), {tile.rgb, tile.opacity, tile.depth},
                                   0, count);
  return end;
}

namespace {

// Names the first ray whose colour is not finite, and the stage that spoilt it.
//   target  [R,3] of the tile, whose first ray is `first` of the batch
std::string DescribeNonFinite(const FieldTile& field, std::span<const std::int64_t> ray,
                              std::span<const float> t, std::span<const float> target,
                              std::int64_t first) {
  for (std::size_t i = 0; i < ray.size(); ++i) {
    if (!std::isfinite(field.density.sigma[i])) {
      return fmt::format("ray {}, stage density, sample at t = {}", ray[i], t[i]);
    }
    for (int c = 0; c < 3; ++c) {
      if (!std::isfinite(field.radiance[3 * i + c])) {
        return fmt::format("ray {}, stage colour, sample at t = {}", ray[i], t[i]);
      }
    }
  }
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (!std::isfinite(target[i])) {
      return fmt::format("ray {}, stage target colours", first + static_cast<std::int64_t>(i / 3));
    }
  }
  return "stage compositing or loss";
}

// Loss of one colour channel and its derivative, as ColorLoss defines them.
struct ChannelLoss {
  double value, derivative;
};
ChannelLoss LossOf(double error, const LossOptions& options) {
  if (options.kind == "mse") return {error * error, 2 * error};
  const double size = std::fabs(error), delta = options.huber_delta;
  if (size <= delta) return {0.5 * error * error / delta, error / delta};
  return {size - 0.5 * delta, error > 0 ? 1.0 : -1.0};
}

}  // namespace

// From the pixels of a tile back to the field.
void FusedEngine::Backward(const TargetBatch& batch, std::int64_t first, Worker& worker,
                           std::span<float> ray_error) const {
  Tile& tile = worker.tile;
  const std::int64_t count = tile.Rays(), size = tile.samples.Size();
  const double channels = 3.0 * static_cast<double>(batch.rays.Size());
  worker.dL_drgb.resize(3 * count);
  double loss = 0;
  for (std::int64_t r = 0; r < count; ++r) {
    double squared = 0;
    for (std::int64_t i = 3 * r; i < 3 * r + 3; ++i) {
      const double error =
          static_cast<double>(tile.rgb[i]) - static_cast<double>(batch.rgb[3 * first + i]);
      const ChannelLoss of_channel = LossOf(error, parts_.loss);
      loss += of_channel.value;
      squared += error * error;
      worker.dL_drgb[i] = static_cast<float>(of_channel.derivative / channels);
    }
    worker.squared_error += squared;
    ray_error[first + r] = static_cast<float>(squared / 3);
  }
  if (!std::isfinite(loss)) {
    throw NonFiniteError("the loss is not finite: " +
                         DescribeNonFinite(tile.field, tile.ray, tile.samples.t,
                                           std::span(batch.rgb).subspan(3 * first, 3 * count),
                                           first));
  }
  worker.loss += loss;

  worker.dL_dopacity.assign(count, 0.0f);
  worker.dL_ddepth.assign(count, 0.0f);
  worker.dL_dbackground.resize(3 * count);
  worker.dL_dsigma.resize(size);
  worker.dL_dradiance.resize(3 * size);
  kernels::CompositeBackward<float>(
      tile.Segments(batch.rays, first), {worker.dL_drgb, worker.dL_dopacity, worker.dL_ddepth},
      {worker.dL_dsigma, worker.dL_dradiance, worker.dL_dbackground}, 0, count);
  if (proposal_) {
    LapTimer timer;
    proposal_->Backward(batch.rays.Size(), tile.ray_begin, tile.field.density.sigma,
                        tile.samples.dt, tile.proposal, worker.dL_dsigma, worker.proposal);
    timer.Lap(tile.sampling_seconds);
  }
  if (const double full = parts_.gradient_scaling.full_distance; full > 0) {
    for (std::int64_t i = 0; i < size; ++i) {
      const double distance = static_cast<double>(tile.samples.t[i]) / full;
      const auto scale = static_cast<float>(std::min(1.0, distance * distance));
      worker.dL_dsigma[i] *= scale;
      for (int c = 0; c < 3; ++c) worker.dL_dradiance[3 * i + c] *= scale;
    }
  }
  field_.Backward(size, tile.samples.position, worker.dL_dsigma, worker.dL_dradiance, tile.field,
                  worker.field);
}

RenderOutput FusedEngine::Render(const RayBatch& rays) {
  CheckRays(rays);
  Refresh();
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
    Tile tile;
    LapTimer timer;
    const std::int64_t last = std::min(count, (chunk + 1) * kChunk);
    for (std::int64_t first = chunk * kChunk; first < last;) {
      const std::int64_t next = Forward(rays, first, last, tile);
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
  const std::int64_t count = batch.rays.Size();
  // A fixed share of the rays for each thread, so that sums repeat bit for bit.
  const auto threads = static_cast<std::int64_t>(NumThreads());
  workers_.resize(threads);
  StepResult result;
  result.ray_error.resize(count);
  ParallelFor(threads, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      Worker& worker = workers_[k];
      worker.loss = worker.squared_error = 0;
      worker.tile.placed = worker.tile.shaded = 0;
      worker.tile.sampling_seconds = 0;
      worker.tile.field.density.seconds = {};
      LapTimer timer;
      field_.Clear(worker.field);
      if (proposal_) proposal_->Clear(worker.proposal);
      const std::int64_t last = count * (k + 1) / threads;
      for (std::int64_t first = count * k / threads; first < last;) {
        const std::int64_t next = Forward(batch.rays, first, last, worker.tile);
        Backward(batch, first, worker, result.ray_error);
        first = next;
      }
      double all = 0;
      timer.Lap(all);
      worker.seconds = worker.tile.Seconds(all);
    }
  });

  std::vector<const FieldGradients*> of_field;
  std::vector<const DensityGradients*> of_proposal;
  for (const Worker& worker : workers_) {
    of_field.push_back(&worker.field);
    of_proposal.push_back(&worker.proposal);
    result.loss += worker.loss;
    result.squared_error += worker.squared_error;
    result.marched += worker.tile.placed;
    result.shaded += worker.tile.shaded;
    result.seconds.Add(worker.seconds, 1.0 / static_cast<double>(threads));
  }
  LapTimer timer;
  field_.AddToParameters(of_field);
  timer.Lap(result.seconds.encoding);
  if (proposal_) {
    proposal_->AddToParameters(of_proposal);
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
        field_.Density().ContractedDensity(positions.subspan(3 * first, 3 * size), tile);
        std::copy(tile.sigma.begin(), tile.sigma.end(), sigma.begin() + first);
      }
    });
    return sigma;
  });
}

}  // namespace nerf
