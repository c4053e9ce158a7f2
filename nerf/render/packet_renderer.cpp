#include "nerf/render/packet_renderer.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "nerf/parallel.h"
#include "nerf/sampling/ray_intervals.h"

namespace nerf {
namespace {

// Rays of a tile, a whole number of packets, and the samples that each goes on by at a time: their
// activations fit the second-level cache.
constexpr std::int64_t kTileRays = 128;
constexpr std::int64_t kSlab = 4;

// Light that gets through where a packet's samples missed what its ray meets.
constexpr double kMissed = 0.1;

ProposalOptions WithSamples(ProposalOptions options, int samples) {
  options.samples = samples;
  return options;
}

// A ray on its way.
struct RayState {
  std::int64_t next = 0, end = 0;  // samples ahead
  double optical_depth = 0;
  float met = 0;     // weight so far
  float shaded = 0;  // weight that has a colour
  float heaviest_weight = 0;
  std::int64_t heaviest = 0;  // sample
  float weighted_t = 0;
  float rgb[3] = {0, 0, 0};

  double Transmittance() const { return std::exp(-optical_depth); }
};

}  // namespace

struct PacketRenderer::Tile {
  RayBatch packets;  // a ray for each packet, through its middle
  ProposalTile proposal;
  RaySamples samples;
  std::vector<RayState> rays;
  std::vector<std::int64_t> alive;  // rays of the tile

  // Of the samples that the rays go on by.
  std::vector<float> position;            // [S,3]
  std::vector<std::int64_t> sample, ray;  // [S] of the tile
  std::vector<std::int64_t> kept, kept_ray;
  std::vector<float> kept_weight;
  FieldTile field;
  std::int64_t evaluated = 0;
};

PacketRenderer::PacketRenderer(std::shared_ptr<RadianceField> field,
                               std::shared_ptr<OccupancyGrid> grid,
                               std::shared_ptr<ProposalField> proposal, const MarchOptions& march,
                               ProposalOptions proposal_options, const RenderQuality& quality,
                               kernels::Precision precision)
    : field_(std::move(field), precision),
      grid_(std::move(grid)),
      march_(march),
      quality_(quality) {
  if (proposal) {
    proposal_.emplace(std::move(proposal),
                      WithSamples(std::move(proposal_options), quality.samples), march);
  }
}

namespace {

// The ray through the middle of each packet of rays [first, last).
void MiddleRays(const RayBatch& rays, std::int64_t first, std::int64_t last, std::int64_t packet,
                RayBatch& out) {
  out.Resize((last - first + packet - 1) / packet);
  for (std::int64_t p = 0; p < out.Size(); ++p) {
    const std::int64_t begin = first + p * packet, end = std::min(last, begin + packet);
    Eigen::Vector3f origin = Eigen::Vector3f::Zero(), direction = Eigen::Vector3f::Zero();
    for (std::int64_t r = begin; r < end; ++r) {
      origin += Eigen::Map<const Eigen::Vector3f>(&rays.origin[3 * r]);
      direction += Eigen::Map<const Eigen::Vector3f>(&rays.direction[3 * r]);
    }
    Eigen::Map<Eigen::Vector3f>(&out.origin[3 * p]) = origin / static_cast<float>(end - begin);
    Eigen::Map<Eigen::Vector3f>(&out.direction[3 * p]) = direction.normalized();
    out.jitter[p] = rays.jitter[begin];
  }
}

}  // namespace

// Sets ray k of the tile on its way through the given intervals.
void PacketRenderer::PackRay(const RayBatch& rays, std::int64_t r, std::span<const float> edges,
                             std::int64_t k, Tile& tile) const {
  const std::int64_t each = quality_.samples;
  RaySamples& s = tile.samples;
  tile.rays[k] = {};
  tile.rays[k].next = k * each;
  tile.rays[k].end = (k + 1) * each;
  PackIntervalsOfRay(rays, r, edges, std::span(s.position).subspan(3 * k * each, 3 * each),
                     std::span(s.t).subspan(k * each, each),
                     std::span(s.dt).subspan(k * each, each));
}

void PacketRenderer::PlaceSamples(const RayBatch& rays, std::int64_t first, std::int64_t last,
                                  Tile& tile) const {
  const std::int64_t count = last - first;
  tile.rays.assign(count, {});
  RaySamples& s = tile.samples;
  if (!proposal_) {
    s.position.clear();
    s.t.clear();
    s.dt.clear();
    for (std::int64_t k = 0; k < count; ++k) {
      tile.rays[k].next = s.Size();
      MarchRay(rays, first + k, *grid_, march_, s);
      tile.rays[k].end = s.Size();
    }
    return;
  }
  if (quality_.packet == 1) {
    proposal_->Cut(rays, first, last, tile.proposal);
  } else {
    MiddleRays(rays, first, last, quality_.packet, tile.packets);
    proposal_->Cut(tile.packets, 0, tile.packets.Size(), tile.proposal);
  }
  const std::int64_t each = quality_.samples;
  s.position.resize(3 * count * each);
  s.t.resize(count * each);
  s.dt.resize(count * each);
  for (std::int64_t k = 0; k < count; ++k) {
    PackRay(rays, first + k,
            std::span(tile.proposal.edges).subspan(k / quality_.packet * (each + 1), each + 1), k,
            tile);
  }
}

// Rays beside an edge, for which the middle of their packet looked in the wrong place: much light
// still gets through. They are placed anew, each by itself.
void PacketRenderer::PlaceMissed(const RayBatch& rays, std::int64_t first, Tile& tile) const {
  if (!proposal_ || quality_.packet == 1) return;
  for (std::size_t k = 0; k < tile.rays.size(); ++k) {
    const RayState& ray = tile.rays[k];
    if (ray.next == ray.end && ray.Transmittance() > kMissed) {
      tile.alive.push_back(static_cast<std::int64_t>(k));
    }
  }
  const std::int64_t each = quality_.samples;
  tile.packets.Resize(static_cast<std::int64_t>(tile.alive.size()));
  for (std::int64_t m = 0; m < tile.packets.Size(); ++m) {
    const std::int64_t r = first + tile.alive[m];
    std::copy_n(&rays.origin[3 * r], 3, &tile.packets.origin[3 * m]);
    std::copy_n(&rays.direction[3 * r], 3, &tile.packets.direction[3 * m]);
    tile.packets.jitter[m] = rays.jitter[r];
  }
  proposal_->Cut(tile.packets, 0, tile.packets.Size(), tile.proposal);
  for (std::int64_t m = 0; m < tile.packets.Size(); ++m) {
    const std::int64_t k = tile.alive[m];
    PackRay(rays, first + k, std::span(tile.proposal.edges).subspan(m * (each + 1), each + 1), k,
            tile);
  }
}

// Gives a colour to the samples that are kept, and adds them to their rays.
void PacketRenderer::Shade(const RayBatch& rays, std::int64_t first, Tile& tile) const {
  field_.Density().Keep(tile.kept, tile.field.density);
  const auto count = static_cast<std::int64_t>(tile.kept.size());
  field_.Radiance(count, tile.kept_ray, std::span(rays.direction).subspan(3 * first), tile.field);
  for (std::int64_t i = 0; i < count; ++i) {
    RayState& ray = tile.rays[tile.kept_ray[i]];
    const float weight = tile.kept_weight[i];
    ray.shaded += weight;
    for (int c = 0; c < 3; ++c) ray.rgb[c] += weight * tile.field.radiance[3 * i + c];
  }
}

// Takes every ray that is still alive a few samples further.
void PacketRenderer::Advance(const RayBatch& rays, std::int64_t first, Tile& tile) const {
  tile.position.clear();
  tile.sample.clear();
  tile.ray.clear();
  const RaySamples& s = tile.samples;
  for (const std::int64_t k : tile.alive) {
    RayState& ray = tile.rays[k];
    const std::int64_t end = std::min(ray.end, ray.next + kSlab);
    tile.position.insert(tile.position.end(), s.position.begin() + 3 * ray.next,
                         s.position.begin() + 3 * end);
    for (; ray.next < end; ++ray.next) {
      tile.sample.push_back(ray.next);
      tile.ray.push_back(k);
    }
  }
  field_.Density().Density(tile.position, tile.field.density);
  tile.evaluated += static_cast<std::int64_t>(tile.sample.size());

  tile.kept.clear();
  tile.kept_ray.clear();
  tile.kept_weight.clear();
  const auto share = static_cast<float>(quality_.color_share);
  const auto shares_met = [share](float weight) { return std::floor(weight / share + 0.5f); };
  for (std::size_t i = 0; i < tile.sample.size(); ++i) {
    RayState& ray = tile.rays[tile.ray[i]];
    const float dt = s.dt[tile.sample[i]];
    // As CompositeForward has it: an interval of length 0 is empty, whatever its density.
    const double x = dt > 0 ? static_cast<double>(tile.field.density.sigma[i]) * dt : 0;
    const auto weight = static_cast<float>(ray.Transmittance() * -std::expm1(-x));
    ray.optical_depth += x;
    ray.weighted_t += weight * s.t[tile.sample[i]];
    const float before = ray.met;
    ray.met += weight;
    if (weight > ray.heaviest_weight) {
      ray.heaviest_weight = weight;
      ray.heaviest = tile.sample[i];
    }
    const float counts =
        quality_.color_share > 0 ? share * (shares_met(ray.met) - shares_met(before)) : weight;
    if (counts == 0) continue;  // NaN goes on, to be seen
    tile.kept.push_back(static_cast<std::int64_t>(i));
    tile.kept_ray.push_back(tile.ray[i]);
    tile.kept_weight.push_back(counts);
  }
  Shade(rays, first, tile);
  std::erase_if(tile.alive, [&](std::int64_t k) {
    const RayState& ray = tile.rays[k];
    return ray.next == ray.end || ray.Transmittance() < quality_.stop_transmittance;
  });
}

// Rays that met less than half a share, through thin fog, take the colour of their heaviest sample.
void PacketRenderer::ShadeFaint(const RayBatch& rays, std::int64_t first, Tile& tile) const {
  tile.position.clear();
  tile.kept.clear();
  tile.kept_ray.clear();
  for (std::size_t k = 0; k < tile.rays.size(); ++k) {
    const RayState& ray = tile.rays[k];
    if (!(ray.shaded == 0 && ray.met > 0)) continue;
    const auto position = tile.samples.position.begin() + 3 * ray.heaviest;
    tile.position.insert(tile.position.end(), position, position + 3);
    tile.kept.push_back(static_cast<std::int64_t>(tile.kept.size()));
    tile.kept_ray.push_back(static_cast<std::int64_t>(k));
  }
  if (tile.kept.empty()) return;
  tile.kept_weight.assign(tile.kept.size(), 1.0f);
  field_.Density().Density(tile.position, tile.field.density);
  tile.evaluated += static_cast<std::int64_t>(tile.kept.size());
  Shade(rays, first, tile);
}

RenderOutput PacketRenderer::Render(const RayBatch& rays) {
  CheckRays(rays);
  field_.Refresh();
  if (proposal_) proposal_->Refresh();
  const std::int64_t count = rays.Size();
  RenderOutput out;
  out.rgb.resize(3 * count);
  out.opacity.resize(count);
  out.depth.resize(count);
  const auto near = static_cast<float>(march_.near_distance);
  const auto far = static_cast<float>(march_.far_distance);
  std::atomic<std::int64_t> samples = 0;
  ParallelForEach((count + kTileRays - 1) / kTileRays, [&](std::int64_t part) {
    thread_local Tile tile;
    const std::int64_t first = part * kTileRays, last = std::min(count, first + kTileRays);
    tile.evaluated = 0;
    PlaceSamples(rays, first, last, tile);
    tile.alive.clear();
    for (std::int64_t k = 0; k < last - first; ++k) {
      if (tile.rays[k].next < tile.rays[k].end) tile.alive.push_back(k);
    }
    while (!tile.alive.empty()) Advance(rays, first, tile);
    PlaceMissed(rays, first, tile);
    while (!tile.alive.empty()) Advance(rays, first, tile);
    ShadeFaint(rays, first, tile);

    for (std::int64_t k = 0; k < last - first; ++k) {
      const RayState& ray = tile.rays[k];
      const std::int64_t r = first + k;
      // What light is left where a ray is given up, and weight without a colour, take on the colour
      // of the rest.
      const bool given_up = ray.next < ray.end;
      const float opacity = given_up ? 1 : static_cast<float>(-std::expm1(-ray.optical_depth));
      const float scale = ray.shaded > 0 ? opacity / ray.shaded : 0.0f;
      const float through = ray.shaded > 0 ? 1 - opacity : 1.0f;
      for (int c = 0; c < 3; ++c) {
        out.rgb[3 * r + c] = scale * ray.rgb[c] + through * rays.background[3 * r + c];
      }
      out.opacity[r] = opacity;
      const auto met = static_cast<float>(-std::expm1(-ray.optical_depth));
      out.depth[r] = met > 0 ? std::clamp(ray.weighted_t / met, near, far) : 0.0f;
    }
    samples += tile.evaluated;
  });
  out.samples = samples;
  return out;
}

}  // namespace nerf
