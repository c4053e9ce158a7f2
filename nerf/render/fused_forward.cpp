#include "nerf/render/fused_forward.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "nerf/effects/anti_aliasing.h"
#include "nerf/sampling/occupancy_grid.h"

namespace nerf {
namespace {

// A tile is full when it has this many samples: their activations, a kilobyte each, fit in a core's
// second-level cache.
constexpr std::int64_t kTileSamples = 256;

}  // namespace

FusedForward::FusedForward(const ModelParts& parts)
    : parts_(parts), field_(*parts.field, parts.config.train.precision) {
  if (parts.proposal) {
    proposal_.emplace(*parts.proposal, parts.config.proposal, parts.config.march);
  }
}

void FusedForward::Refresh(const Annealing& annealing) {
  field_.Refresh(annealing.detail);
  if (proposal_) proposal_->Refresh(annealing.proposal);
}

// Places the samples of rays from `first` on, as many rays as fill a tile. Returns the ray after
// the last.
std::int64_t FusedForward::PlaceSamples(const RayBatch& rays, std::int64_t first, std::int64_t last,
                                        FusedTile& tile) const {
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
    MarchRay(rays, end, *parts_.grid, parts_.config.march, tile.samples);
    tile.ray.resize(tile.samples.Size(), end);
    tile.ray_begin.push_back(tile.samples.Size());
  }
  return end;
}

// Removes the samples behind the point where a ray's transmittance falls below the bound.
void FusedForward::KeepVisible(FusedTile& tile) const {
  const std::int64_t rays = tile.Rays();
  tile.kept_of_ray.resize(rays);
  kernels::CountVisible<float>(tile.ray_begin, tile.field.density.sigma, tile.samples.dt,
                               parts_.config.march.stop_transmittance, tile.kept_of_ray, 0, rays);
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

std::int64_t FusedForward::Run(const RayBatch& rays, std::int64_t first, std::int64_t last,
                               FusedTile& tile) const {
  LapTimer timer;
  const std::int64_t end = PlaceSamples(rays, first, last, tile);
  timer.Lap(tile.sampling_seconds);
  tile.placed += tile.samples.Size();
  if (const auto& anti_aliasing = parts_.config.effects.anti_aliasing) {
    tile.field.density.footprint = Footprints(rays, tile.ray, tile.samples.t, *anti_aliasing);
  }
  field_.Density().Density(tile.samples.position, tile.field.density);
  KeepVisible(tile);
  tile.shaded += tile.samples.Size();
  field_.Radiance(tile.samples.Size(), tile.ray, rays.direction, tile.field);

  LapTimer compositing;
  const std::int64_t count = tile.Rays();
  tile.rgb.resize(3 * count);
  tile.opacity.resize(count);
  tile.depth.resize(count);
  kernels::CompositeForward<float>(tile.Segments(rays, first), {tile.rgb, tile.opacity, tile.depth},
                                   0, count);
  compositing.Lap(tile.compositing_seconds);
  return end;
}

std::string DescribeNonFinite(const FusedTile& tile, std::span<const float> target,
                              std::int64_t first) {
  const FieldTile& field = tile.field;
  const std::vector<std::int64_t>& ray = tile.ray;
  const std::vector<float>& t = tile.samples.t;
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

}  // namespace nerf
