#include "nerf/render/packet_renderer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "nerf/base/parallel.h"
#include "nerf/base/stopwatch.h"
#include "nerf/effects/anti_aliasing.h"

namespace nerf {
namespace {

// Rays of a tile (a whole number of packets), and samples by which each ray advances at a time:
// their activations fit in the second-level cache.
constexpr std::int64_t kTileRays = 128;
constexpr std::int64_t kSlab = 4;

// A ray with more transmittance than this at its end may have hit a surface that the shared samples
// of its packet missed.
constexpr double kMissedTransmittance = 0.1;

}  // namespace

struct PacketRenderer::Tile {
  // A ray that is being followed.
  struct Ray {
    std::int64_t next = 0, end = 0;  // remaining samples
    double optical_depth = 0;
    float accumulated_weight = 0;
    float shaded_weight = 0;  // the part of it with a colour
    float largest_weight = 0;
    std::int64_t largest = 0;  // sample with the largest weight
    float weighted_t = 0;
    float rgb[3] = {0, 0, 0};

    double Transmittance() const { return std::exp(-optical_depth); }
  };

  PlacedTile placed;
  std::vector<Ray> rays;
  std::vector<std::int64_t> alive;  // rays that are not finished, indices into the tile

  // The samples that are being evaluated.
  std::vector<float> position;            // [S,3]
  std::vector<std::int64_t> sample, ray;  // [S] indices into the tile
  std::vector<std::int64_t> kept, kept_ray;
  std::vector<float> kept_weight;
  FieldTile field;
  std::int64_t evaluated = 0;
  double sampling_seconds = 0, compositing_seconds = 0;
};

PacketRenderer::PacketRenderer(const ModelParts& parts, const RenderQuality& quality)
    : parts_(parts),
      field_(*parts.field, parts.config.train.precision),
      placement_(parts, quality),
      quality_(quality) {
  field_.Refresh(parts.annealing.detail);
  if (parts.background) background_ = parts.background->Map();
}

// Places the samples of a tile and starts its rays.
void PacketRenderer::Begin(const RayBatch& rays, std::int64_t first, std::int64_t last,
                           Tile& tile) const {
  LapTimer timer;
  tile.evaluated = 0;
  tile.sampling_seconds = 0;
  tile.compositing_seconds = 0;
  tile.field.density.seconds = {};
  placement_.Place(rays, first, last, tile.placed);
  timer.Lap(tile.sampling_seconds);
  tile.rays.assign(last - first, {});
  tile.alive.clear();
  for (std::int64_t k = 0; k < last - first; ++k) {
    const auto [begin, end] = tile.placed.of_ray[k];
    tile.rays[k].next = begin;
    tile.rays[k].end = end;
    if (begin < end) tile.alive.push_back(k);
  }
}

// Restarts, each with samples of its own, rays for which the shared samples may have missed a
// surface, such as those at a silhouette: their transmittance is high at the end.
void PacketRenderer::RestartMissed(const RayBatch& rays, std::int64_t first, Tile& tile) const {
  if (!placement_.SharesSamples()) return;
  for (std::size_t k = 0; k < tile.rays.size(); ++k) {
    const Tile::Ray& ray = tile.rays[k];
    if (ray.next == ray.end && ray.Transmittance() > kMissedTransmittance) {
      tile.alive.push_back(static_cast<std::int64_t>(k));
    }
  }
  LapTimer timer;
  placement_.PlaceIndividually(rays, first, tile.alive, tile.placed);
  timer.Lap(tile.sampling_seconds);
  for (const std::int64_t k : tile.alive) {
    const auto [begin, end] = tile.placed.of_ray[k];
    tile.rays[k] = {};
    tile.rays[k].next = begin;
    tile.rays[k].end = end;
  }
}

// Evaluates the radiance of the kept samples and adds it to their rays.
void PacketRenderer::Shade(const RayBatch& rays, std::int64_t first, Tile& tile) const {
  field_.Density().Keep(tile.kept, tile.field.density);
  const auto count = static_cast<std::int64_t>(tile.kept.size());
  field_.Radiance(count, tile.kept_ray, std::span(rays.direction).subspan(3 * first), tile.field);
  LapTimer timer;
  for (std::int64_t i = 0; i < count; ++i) {
    Tile::Ray& ray = tile.rays[tile.kept_ray[i]];
    const float weight = tile.kept_weight[i];
    ray.shaded_weight += weight;
    for (int c = 0; c < 3; ++c) ray.rgb[c] += weight * tile.field.radiance[3 * i + c];
  }
  timer.Lap(tile.compositing_seconds);
}

// Evaluates the densities of the tile's current samples.
void PacketRenderer::Evaluate(const RayBatch& rays, std::int64_t first, Tile& tile) const {
  tile.field.density.footprint.clear();  // tiles are shared between renderers of a thread
  if (const auto& options = parts_.config.effects.anti_aliasing) {
    std::vector<std::int64_t> ray;
    std::vector<float> t;
    for (std::size_t i = 0; i < tile.sample.size(); ++i) {
      ray.push_back(first + tile.ray[i]);
      t.push_back(tile.placed.samples.t[tile.sample[i]]);
    }
    tile.field.density.footprint = Footprints(rays, ray, t, *options);
  }
  field_.Density().Density(tile.position, tile.field.density);
  tile.evaluated += static_cast<std::int64_t>(tile.sample.size());
}

// Advances every ray that is alive by a few samples.
void PacketRenderer::Advance(const RayBatch& rays, std::int64_t first, Tile& tile) const {
  LapTimer timer;
  GatherNext(tile);
  timer.Lap(tile.compositing_seconds);
  Evaluate(rays, first, tile);
  timer = {};
  Accumulate(tile);
  timer.Lap(tile.compositing_seconds);
  Shade(rays, first, tile);
  std::erase_if(tile.alive, [&](std::int64_t k) {
    const Tile::Ray& ray = tile.rays[k];
    return ray.next == ray.end || ray.Transmittance() < quality_.stop_transmittance;
  });
}

// Collects the next samples of the rays that are alive.
void PacketRenderer::GatherNext(Tile& tile) {
  tile.position.clear();
  tile.sample.clear();
  tile.ray.clear();
  const RaySamples& s = tile.placed.samples;
  for (const std::int64_t k : tile.alive) {
    Tile::Ray& ray = tile.rays[k];
    const std::int64_t end = std::min(ray.end, ray.next + kSlab);
    tile.position.insert(tile.position.end(), s.position.begin() + 3 * ray.next,
                         s.position.begin() + 3 * end);
    for (; ray.next < end; ++ray.next) {
      tile.sample.push_back(ray.next);
      tile.ray.push_back(k);
    }
  }
}

// Adds the weights of the current samples to their rays, and keeps the samples to be shaded.
void PacketRenderer::Accumulate(Tile& tile) const {
  const RaySamples& s = tile.placed.samples;
  tile.kept.clear();
  tile.kept_ray.clear();
  tile.kept_weight.clear();
  const auto share = static_cast<float>(quality_.color_share);
  // The colour of each share of a ray's weight is that of the sample in its middle.
  const auto completed_shares = [share](float weight) { return std::floor(weight / share + 0.5f); };
  for (std::size_t i = 0; i < tile.sample.size(); ++i) {
    Tile::Ray& ray = tile.rays[tile.ray[i]];
    const float dt = s.dt[tile.sample[i]];
    // As in CompositeForward, an interval of length 0 is empty, whatever its density.
    const double x = dt > 0 ? static_cast<double>(tile.field.density.sigma[i]) * dt : 0;
    const auto weight = static_cast<float>(ray.Transmittance() * -std::expm1(-x));
    ray.optical_depth += x;
    ray.weighted_t += weight * s.t[tile.sample[i]];
    const float before = ray.accumulated_weight;
    ray.accumulated_weight += weight;
    if (weight > ray.largest_weight) {
      ray.largest_weight = weight;
      ray.largest = tile.sample[i];
    }
    const float color_weight =
        quality_.color_share > 0
            ? share * (completed_shares(ray.accumulated_weight) - completed_shares(before))
            : weight;
    if (color_weight == 0) continue;  // a NaN is kept, so that it is visible
    tile.kept.push_back(static_cast<std::int64_t>(i));
    tile.kept_ray.push_back(tile.ray[i]);
    tile.kept_weight.push_back(color_weight);
  }
}

// Rays that accumulated less than half a share of weight get the colour of the sample with the
// largest weight.
void PacketRenderer::ShadeFaint(const RayBatch& rays, std::int64_t first, Tile& tile) const {
  tile.position.clear();
  tile.sample.clear();
  tile.ray.clear();
  tile.kept.clear();
  tile.kept_ray.clear();
  for (std::size_t k = 0; k < tile.rays.size(); ++k) {
    const Tile::Ray& ray = tile.rays[k];
    if (!(ray.shaded_weight == 0 && ray.accumulated_weight > 0)) continue;
    const auto position = tile.placed.samples.position.begin() + 3 * ray.largest;
    tile.position.insert(tile.position.end(), position, position + 3);
    tile.sample.push_back(ray.largest);
    tile.ray.push_back(static_cast<std::int64_t>(k));
    tile.kept.push_back(static_cast<std::int64_t>(tile.kept.size()));
    tile.kept_ray.push_back(static_cast<std::int64_t>(k));
  }
  if (tile.kept.empty()) return;
  tile.kept_weight.assign(tile.kept.size(), 1.0f);
  Evaluate(rays, first, tile);
  Shade(rays, first, tile);
}

// Writes the pixels of a tile whose rays are finished.
void PacketRenderer::Finish(const RayBatch& rays, std::int64_t first, const Tile& tile,
                            RenderOutput& out) const {
  const auto near = static_cast<float>(parts_.config.march.near_distance);
  const auto far = static_cast<float>(parts_.config.march.far_distance);
  for (std::size_t k = 0; k < tile.rays.size(); ++k) {
    const Tile::Ray& ray = tile.rays[k];
    const std::int64_t r = first + static_cast<std::int64_t>(k);
    // A ray that was stopped early counts as opaque. Its remaining transmittance, and weight
    // without a colour, get the mean colour of the rest.
    const bool stopped_early = ray.next < ray.end;
    const float opacity = stopped_early ? 1 : static_cast<float>(-std::expm1(-ray.optical_depth));
    const float scale = ray.shaded_weight > 0 ? opacity / ray.shaded_weight : 0.0f;
    const float transmittance = ray.shaded_weight > 0 ? 1 - opacity : 1.0f;
    for (int c = 0; c < 3; ++c) {
      out.rgb[3 * r + c] = scale * ray.rgb[c] + transmittance * rays.background[3 * r + c];
    }
    out.opacity[r] = opacity;
    const auto weight = static_cast<float>(-std::expm1(-ray.optical_depth));
    out.depth[r] = weight > 0 ? std::clamp(ray.weighted_t / weight, near, far) : 0.0f;
  }
}

RenderOutput PacketRenderer::RenderRays(const RayBatch& rays) const {
  const std::int64_t count = rays.Size();
  RenderOutput out;
  out.rgb.resize(3 * count);
  out.opacity.resize(count);
  out.depth.resize(count);
  std::atomic<std::int64_t> samples = 0;
  std::mutex adding;
  ParallelForEach((count + kTileRays - 1) / kTileRays, [&](std::int64_t part) {
    thread_local Tile tile;
    const std::int64_t first = part * kTileRays, last = std::min(count, first + kTileRays);
    Begin(rays, first, last, tile);
    while (!tile.alive.empty()) Advance(rays, first, tile);
    RestartMissed(rays, first, tile);
    while (!tile.alive.empty()) Advance(rays, first, tile);
    ShadeFaint(rays, first, tile);
    Finish(rays, first, tile, out);
    samples += tile.evaluated;
    StageSeconds seconds = tile.field.density.seconds;
    seconds.sampling = tile.sampling_seconds;
    seconds.compositing = tile.compositing_seconds;
    const std::lock_guard lock(adding);
    out.seconds.Add(seconds, 1.0 / NumThreads());
  });
  out.samples = samples;
  return out;
}

RenderOutput PacketRenderer::Render(const RayBatch& rays) const {
  CheckRays(rays);
  return parts_.background ? RenderRays(WithBackground(rays, background_)) : RenderRays(rays);
}

}  // namespace nerf
