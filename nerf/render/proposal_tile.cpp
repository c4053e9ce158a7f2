#include "nerf/render/proposal_tile.h"

#include <algorithm>

#include "nerf/kernels/histogram_loss.h"
#include "nerf/kernels/volume_rendering.h"
#include "nerf/sampling/ray_intervals.h"

namespace nerf {

TileProposal::TileProposal(const ProposalField& proposal, const ProposalOptions& options,
                           const MarchOptions& march)
    : proposal_(proposal),
      options_(options),
      march_(march),
      density_(proposal_.Hash(), proposal_.Network()) {}

void TileProposal::Refresh(double exponent) {
  exponent_ = static_cast<float>(exponent);
  density_.Refresh(std::vector<float>(proposal_.Hash().Layout().levels.size(), 1.0f));
}

void TileProposal::Resample(const RayBatch& rays, std::int64_t first, std::int64_t last,
                            ProposalTile& tile) const {
  const std::int64_t count = last - first, coarse = options_.intervals, fine = options_.samples;
  tile.coarse_edges.resize(count * (coarse + 1));
  tile.edges.resize(count * (fine + 1));
  tile.position.resize(3 * count * coarse);
  tile.t.resize(count * coarse);
  tile.dt.resize(count * coarse);
  tile.weights.resize(count * coarse);
  tile.ray_begin.resize(count + 1);
  const auto coarse_edges = [&](std::int64_t k) {
    return std::span(tile.coarse_edges).subspan(k * (coarse + 1), coarse + 1);
  };
  for (std::int64_t k = 0; k < count; ++k) {
    tile.ray_begin[k + 1] = (k + 1) * coarse;
    EqualIntervals(rays, first + k, march_, coarse_edges(k));
    PackIntervalsOfRay(rays, first + k, march_, coarse_edges(k),
                       std::span(tile.position).subspan(3 * k * coarse, 3 * coarse),
                       std::span(tile.t).subspan(k * coarse, coarse),
                       std::span(tile.dt).subspan(k * coarse, coarse));
  }
  density_.Density(tile.position, tile.density);
  kernels::WeightsForward<float>(tile.ray_begin, tile.density.sigma, tile.dt, tile.weights, 0,
                                 count);

  for (std::int64_t k = 0; k < count; ++k) {
    ResampleAnnealed(coarse_edges(k), std::span(tile.weights).subspan(k * coarse, coarse),
                     exponent_, static_cast<float>(options_.padding), rays.jitter[first + k],
                     std::span(tile.edges).subspan(k * (fine + 1), fine + 1));
  }
}

void TileProposal::Propose(const RayBatch& rays, std::int64_t first, std::int64_t last,
                           ProposalTile& tile, RaySamples& samples) const {
  Resample(rays, first, last, tile);
  const std::int64_t count = last - first, fine = options_.samples;
  samples.position.resize(3 * count * fine);
  samples.t.resize(count * fine);
  samples.dt.resize(count * fine);
  for (std::int64_t k = 0; k < count; ++k) {
    PackIntervalsOfRay(rays, first + k, march_,
                       std::span(tile.edges).subspan(k * (fine + 1), fine + 1),
                       std::span(samples.position).subspan(3 * k * fine, 3 * fine),
                       std::span(samples.t).subspan(k * fine, fine),
                       std::span(samples.dt).subspan(k * fine, fine));
  }
}

void TileProposal::Backward(std::int64_t rays, std::span<const std::int64_t> ray_begin,
                            std::span<const float> sigma, std::span<const float> dt,
                            ProposalTile& tile, std::span<float> dL_dsigma,
                            DensityGradients& gradients) const {
  const auto count = static_cast<std::int64_t>(ray_begin.size()) - 1;
  const std::int64_t coarse = options_.intervals, fine = options_.samples;
  std::vector<float> weights(sigma.size());
  kernels::WeightsForward<float>(ray_begin, sigma, dt, weights, 0, count);

  tile.dL_dweights.resize(count * coarse);
  for (std::int64_t k = 0; k < count; ++k) {
    const std::int64_t begin = ray_begin[k], size = ray_begin[k + 1] - begin;
    kernels::HistogramBoundLoss<float>(
        std::span(tile.edges).subspan(k * (fine + 1), size + 1),
        std::span(weights).subspan(begin, size),
        std::span(tile.coarse_edges).subspan(k * (coarse + 1), coarse + 1),
        std::span(tile.weights).subspan(k * coarse, coarse),
        std::span(tile.dL_dweights).subspan(k * coarse, coarse));
  }
  const double per_ray = 1.0 / static_cast<double>(rays);
  const auto scale = static_cast<float>(options_.loss_weight * per_ray);
  for (float& g : tile.dL_dweights) g *= scale;
  tile.dL_dsigma.resize(count * coarse);
  kernels::WeightsBackward<float>(tile.ray_begin, tile.density.sigma, tile.dt, tile.dL_dweights,
                                  tile.dL_dsigma, 0, count);
  density_.Backward(count * coarse, tile.position, tile.dL_dsigma, tile.density, gradients);

  if (options_.distortion == 0) return;
  std::vector<float> dL_dweights(weights.size()), of_sigma(weights.size());
  for (std::int64_t k = 0; k < count; ++k) {
    const std::int64_t begin = ray_begin[k], size = ray_begin[k + 1] - begin;
    tile.places.resize(size + 1);
    for (std::int64_t i = 0; i <= size; ++i) {
      tile.places[i] = NormalizedDistance(tile.edges[k * (fine + 1) + i], march_);
    }
    kernels::DistortionLoss<float>(tile.places, std::span(weights).subspan(begin, size),
                                   std::span(dL_dweights).subspan(begin, size));
  }
  kernels::WeightsBackward<float>(ray_begin, sigma, dt, dL_dweights, of_sigma, 0, count);
  const auto distortion = static_cast<float>(options_.distortion * per_ray);
  for (std::size_t i = 0; i < of_sigma.size(); ++i) dL_dsigma[i] += distortion * of_sigma[i];
}

}  // namespace nerf
