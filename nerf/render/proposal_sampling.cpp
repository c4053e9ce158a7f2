#include "nerf/render/proposal_sampling.h"

#include <Eigen/Core>
#include <cmath>

#include "nerf/base/parallel.h"
#include "nerf/field/tensor_span.h"
#include "nerf/kernels/histogram_loss.h"
#include "nerf/render/volume_rendering.h"
#include "nerf/sampling/contraction.h"

namespace nerf {
namespace {

constexpr std::int64_t kMinProposalsPerThread = 16;

// The sum over rays of a loss of their weights. `of_ray(r, weights, dL_dweights)` returns the loss
// of a ray and writes its gradient.
struct LossOfWeightsFunction : torch::autograd::Function<LossOfWeightsFunction> {
  template <class OfRay>
  static torch::Tensor forward(torch::autograd::AutogradContext* ctx, const torch::Tensor& weights,
                               const std::vector<std::int64_t>* ray_begin, const OfRay* of_ray) {
    const torch::Tensor gradient = torch::zeros_like(weights);
    const auto rays = static_cast<std::int64_t>(ray_begin->size()) - 1;
    std::vector<double> loss(rays);
    AT_DISPATCH_FLOATING_TYPES(weights.scalar_type(), "loss_of_weights", [&] {
      ParallelFor(rays, kMinProposalsPerThread, [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t r = first; r < last; ++r) {
          const std::int64_t begin = (*ray_begin)[r], count = (*ray_begin)[r + 1] - begin;
          loss[r] = (*of_ray)(r, Span<const scalar_t>(weights).subspan(begin, count),
                              Span<scalar_t>(gradient).subspan(begin, count));
        }
      });
    });
    ctx->save_for_backward({gradient});
    double sum = 0;
    for (const double of_one : loss) sum += of_one;
    return torch::full({}, sum, weights.options());
  }
  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* ctx,
                                                 torch::autograd::variable_list grads) {
    return {ctx->get_saved_variables()[0] * grads[0], torch::Tensor(), torch::Tensor()};
  }
};

template <class Real>
std::vector<Real> EdgesOfRay(const std::vector<float>& edges, std::int64_t r, std::int64_t count) {
  return {edges.begin() + r * count, edges.begin() + (r + 1) * count};
}

std::vector<std::int64_t> EvenBegins(std::int64_t rays, std::int64_t samples) {
  std::vector<std::int64_t> begin(rays + 1);
  for (std::int64_t r = 0; r <= rays; ++r) begin[r] = r * samples;
  return begin;
}

}  // namespace

PackedSamples PackIntervals(const RayBatch& rays, const MarchOptions& march,
                            const std::vector<float>& edges, std::int64_t intervals) {
  const std::int64_t count = rays.Size();
  PackedSamples out;
  out.ray_begin = EvenBegins(count, intervals);
  out.ray.resize(count * intervals);
  out.position.resize(3 * count * intervals);
  out.t.resize(count * intervals);
  out.dt.resize(count * intervals);
  ParallelFor(count, kMinProposalsPerThread, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t r = first; r < last; ++r) {
      PackIntervalsOfRay(rays, r, march,
                         std::span(edges).subspan(r * (intervals + 1), intervals + 1),
                         std::span(out.position).subspan(3 * r * intervals, 3 * intervals),
                         std::span(out.t).subspan(r * intervals, intervals),
                         std::span(out.dt).subspan(r * intervals, intervals));
      std::fill_n(out.ray.begin() + r * intervals, intervals, r);
    }
  });
  return out;
}

ProposedSamples ProposeSamples(const RayBatch& rays, ProposalField& proposal,
                               const ProposalOptions& options, const MarchOptions& march,
                               double exponent) {
  const std::int64_t count = rays.Size(), coarse = options.intervals, fine = options.samples;
  ProposedSamples out;
  out.coarse_edges.resize(count * (coarse + 1));
  ParallelFor(count, kMinProposalsPerThread, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t r = first; r < last; ++r) {
      EqualIntervals(rays, r, march,
                     std::span(out.coarse_edges).subspan(r * (coarse + 1), coarse + 1));
    }
  });
  const PackedSamples coarse_samples = PackIntervals(rays, march, out.coarse_edges, coarse);
  const torch::Dtype dtype = proposal.Hash().Table().scalar_type();
  // Cloned, because the backward pass reads them after coarse_samples is gone.
  const auto own = [](const auto& values, at::IntArrayRef shape, torch::Dtype type) {
    return TensorOf(values, shape, type).clone();
  };
  const torch::Tensor sigma =
      proposal.Density(own(coarse_samples.position, {count * coarse, 3}, dtype));
  out.coarse_weights = RenderWeights(own(coarse_samples.ray_begin, {count + 1}, torch::kLong),
                                     sigma, own(coarse_samples.dt, {count * coarse}, dtype));

  const torch::Tensor weights = out.coarse_weights.detach().to(torch::kFloat).contiguous();
  out.edges.resize(count * (fine + 1));
  ParallelFor(count, kMinProposalsPerThread, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t r = first; r < last; ++r) {
      ResampleAnnealed(std::span(out.coarse_edges).subspan(r * (coarse + 1), coarse + 1),
                       Span<const float>(weights).subspan(r * coarse, coarse),
                       static_cast<float>(exponent), static_cast<float>(options.padding),
                       rays.jitter[r], std::span(out.edges).subspan(r * (fine + 1), fine + 1));
    }
  });
  out.samples = PackIntervals(rays, march, out.edges, fine);
  return out;
}

torch::Tensor ProposalLoss(const ProposedSamples& proposed, const PackedSamples& visible,
                           const torch::Tensor& sigma, const ProposalOptions& options,
                           const MarchOptions& march) {
  const std::int64_t rays = visible.Rays(), size = visible.Size();
  const std::int64_t coarse = options.intervals, fine = options.samples;
  const torch::Tensor weights =
      RenderWeights(TensorOf(visible.ray_begin, {rays + 1}, torch::kLong), sigma,
                    TensorOf(visible.dt, {size}, sigma.scalar_type()));
  const auto coarse_begin = EvenBegins(rays, coarse);
  const torch::Tensor fixed = weights.detach();
  const auto bound_loss = [&]<class Real>(std::int64_t r, std::span<const Real> coarse_weights,
                                          std::span<Real> gradient) {
    const std::int64_t begin = visible.ray_begin[r], count = visible.ray_begin[r + 1] - begin;
    const auto edges = EdgesOfRay<Real>(proposed.edges, r, fine + 1);
    const auto coarse_edges = EdgesOfRay<Real>(proposed.coarse_edges, r, coarse + 1);
    return kernels::HistogramBoundLoss<Real>(std::span(edges).first(count + 1),
                                             Span<const Real>(fixed).subspan(begin, count),
                                             coarse_edges, coarse_weights, gradient);
  };
  torch::Tensor loss =
      options.loss_weight *
      LossOfWeightsFunction::apply(proposed.coarse_weights, &coarse_begin, &bound_loss);
  if (options.distortion > 0) {
    const auto distortion = [&]<class Real>(std::int64_t r, std::span<const Real> of_ray,
                                            std::span<Real> gradient) {
      auto places = EdgesOfRay<Real>(proposed.edges, r, fine + 1);
      for (Real& place : places)
        place = static_cast<Real>(NormalizedDistance(static_cast<float>(place), march));
      return kernels::DistortionLoss<Real>(std::span(places).first(of_ray.size() + 1), of_ray,
                                           gradient);
    };
    loss = loss + options.distortion *
                      LossOfWeightsFunction::apply(weights, &visible.ray_begin, &distortion);
  }
  return loss / static_cast<double>(std::max<std::int64_t>(1, rays));
}

}  // namespace nerf
