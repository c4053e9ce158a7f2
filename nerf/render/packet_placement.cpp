#include "nerf/render/packet_placement.h"

#include <algorithm>

#include "nerf/sampling/ray_intervals.h"

namespace nerf {
namespace {

ProposalOptions WithSamples(ProposalOptions options, int samples) {
  options.samples = samples;
  return options;
}

// The mean ray of each packet of rays [first, last).
void MeanRays(const RayBatch& rays, std::int64_t first, std::int64_t last, std::int64_t packet,
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

PacketPlacement::PacketPlacement(const ModelParts& parts, const RenderQuality& quality)
    : grid_(*parts.grid),
      march_(parts.config.march),
      packet_(quality.packet),
      samples_(quality.samples) {
  if (!parts.proposal) return;
  proposal_.emplace(*parts.proposal, WithSamples(parts.config.proposal, quality.samples), march_);
  proposal_->Refresh(parts.annealing.proposal);
}

// Gives ray r of the batch, which is ray k of the tile, the intervals of ray `from` of the
// proposal's tile.
void PacketPlacement::PackRay(const RayBatch& rays, std::int64_t r, std::int64_t from,
                              std::int64_t k, PlacedTile& tile) const {
  const std::int64_t each = samples_;
  RaySamples& s = tile.samples;
  tile.of_ray[k] = {k * each, (k + 1) * each};
  PackIntervalsOfRay(
      rays, r, march_, std::span(tile.proposal.edges).subspan(from * (each + 1), each + 1),
      std::span(s.position).subspan(3 * k * each, 3 * each), std::span(s.t).subspan(k * each, each),
      std::span(s.dt).subspan(k * each, each));
}

void PacketPlacement::Place(const RayBatch& rays, std::int64_t first, std::int64_t last,
                            PlacedTile& tile) const {
  const std::int64_t count = last - first;
  tile.of_ray.resize(count);
  RaySamples& s = tile.samples;
  if (!proposal_) {
    s.position.clear();
    s.t.clear();
    s.dt.clear();
    for (std::int64_t k = 0; k < count; ++k) {
      const std::int64_t begin = s.Size();
      MarchRay(rays, first + k, grid_, march_, s);
      tile.of_ray[k] = {begin, s.Size()};
    }
    return;
  }
  if (packet_ == 1) {
    proposal_->Resample(rays, first, last, tile.proposal);
  } else {
    MeanRays(rays, first, last, packet_, tile.proposal_rays);
    proposal_->Resample(tile.proposal_rays, 0, tile.proposal_rays.Size(), tile.proposal);
  }
  s.position.resize(3 * count * samples_);
  s.t.resize(count * samples_);
  s.dt.resize(count * samples_);
  for (std::int64_t k = 0; k < count; ++k) PackRay(rays, first + k, k / packet_, k, tile);
}

void PacketPlacement::PlaceIndividually(const RayBatch& rays, std::int64_t first,
                                        std::span<const std::int64_t> missed,
                                        PlacedTile& tile) const {
  const auto count = static_cast<std::int64_t>(missed.size());
  tile.proposal_rays.Resize(count);
  for (std::int64_t m = 0; m < count; ++m) {
    const std::int64_t r = first + missed[m];
    std::copy_n(&rays.origin[3 * r], 3, &tile.proposal_rays.origin[3 * m]);
    std::copy_n(&rays.direction[3 * r], 3, &tile.proposal_rays.direction[3 * m]);
    tile.proposal_rays.jitter[m] = rays.jitter[r];
  }
  proposal_->Resample(tile.proposal_rays, 0, count, tile.proposal);
  for (std::int64_t m = 0; m < count; ++m) PackRay(rays, first + missed[m], m, missed[m], tile);
}

}  // namespace nerf
