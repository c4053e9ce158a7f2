#include "nerf/render/proposal_sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/central_differences.h"

namespace nerf {
namespace {

RayBatch SomeRays(int count) {
  RayBatch rays;
  rays.Resize(count);
  for (int r = 0; r < count; ++r) {
    const Eigen::Vector3f d =
        Eigen::Vector3f(std::sin(r), std::cos(1.7f * r), std::sin(0.3f * r)).normalized();
    for (int c = 0; c < 3; ++c) {
      rays.origin[3 * r + c] = -1.2f * d[c] + 0.1f * static_cast<float>(c);
      rays.direction[3 * r + c] = d[c];
      rays.background[3 * r + c] = 0.5f;
    }
    rays.jitter[r] = 0.3f;
  }
  return rays;
}

ProposalOptions SmallProposal() {
  ProposalOptions options;
  options.intervals = 10;
  options.samples = 7;
  options.distortion = 0.3;
  options.hidden_width = 5;
  options.encoding = {3, 2, 8, 3, 12};
  return options;
}

void FillTable(ProposalField& proposal, double size) {
  const torch::NoGradGuard no_grad;
  torch::manual_seed(2);
  for (auto& p : proposal.named_parameters()) {
    if (p.key().ends_with("table")) p.value().normal_(0.0, size);
  }
}

TEST(ProposalLoss, GradientsMatchCentralDifferences) {
  const ProposalOptions options = SmallProposal();
  const MarchOptions march;
  const RayBatch rays = SomeRays(4);
  ProposalField proposal(options, 1);
  FillTable(proposal, 1.0);
  proposal.to(torch::kDouble);
  const ProposedSamples first = ProposeSamples(rays, proposal, options, march);
  // The rays stop early, as where the field is opaque.
  PackedSamples visible = KeepFront(first.samples, {7, 5, 0, 6});
  torch::manual_seed(3);
  torch::Tensor sigma = (3 * torch::rand({visible.Size()}, torch::kDouble)).requires_grad_();
  const auto loss = [&] {
    ProposedSamples again = ProposeSamples(rays, proposal, options, march);
    again.edges = first.edges;  // sample positions are not differentiable
    return ProposalLoss(again, visible, sigma, options, march);
  };
  EXPECT_GT(loss().item<double>(), 0);
  for (const torch::Tensor& x : {proposal.Network().Weight(1), proposal.Hash().Table()}) {
    sigma.mutable_grad() = torch::Tensor();
    test::ExpectGradientMatchesCentralDifferences(loss, x, 1e-6, 1e-6);
  }

  // The interlevel loss has no gradient in the field's density.
  ProposalOptions only_distortion = options;
  only_distortion.loss_weight = 0;
  ProposedSamples fixed = first;
  fixed.coarse_weights = first.coarse_weights.detach();
  const auto distortion = [&] {
    return ProposalLoss(fixed, visible, sigma, only_distortion, march);
  };
  test::ExpectGradientMatchesCentralDifferences(distortion, sigma, 1e-6, 1e-6);
  sigma.mutable_grad() = torch::Tensor();
  distortion().backward();
  const torch::Tensor alone = sigma.grad().clone();
  sigma.mutable_grad() = torch::Tensor();
  loss().backward();
  EXPECT_TRUE(torch::allclose(sigma.grad(), alone));
}

TEST(ProposeSamples, IntervalsCoverEachRayForAnyDensity) {
  const ProposalOptions options = SmallProposal();
  const MarchOptions march;
  const RayBatch rays = SomeRays(6);
  for (const double size : {0.0, 1.0, 100.0}) {  // nothing, fog, walls
    ProposalField proposal(options, 1);
    FillTable(proposal, size);
    const ProposedSamples out = ProposeSamples(rays, proposal, options, march);
    ASSERT_EQ(out.samples.Size(), 6 * 7);
    for (std::int64_t r = 0; r < 6; ++r) {
      const auto begin = out.edges.begin() + r * 8;
      EXPECT_TRUE(std::is_sorted(begin, begin + 8));
      EXPECT_GE(*begin, 0.05f);
      EXPECT_LE(*(begin + 7), 100.0f);
      for (std::int64_t i = 7 * r; i < 7 * (r + 1); ++i) {
        EXPECT_EQ(out.samples.ray[i], r);
        EXPECT_GE(out.samples.dt[i], 0.0f);
        EXPECT_TRUE(std::isfinite(out.samples.position[3 * i]));
      }
    }
  }
}

TEST(ProposeSamples, SamplesAreDenserWhereWeightsAreLarge) {
  ProposalOptions options = SmallProposal();
  options.intervals = 64;
  options.samples = 16;
  const MarchOptions march;
  const RayBatch rays = SomeRays(8);
  ProposalField proposal(options, 1);
  FillTable(proposal, 20.0);
  const auto share_in_heaviest = [&](double exponent) {
    const ProposedSamples out = ProposeSamples(rays, proposal, options, march, exponent);
    const torch::Tensor weights = out.coarse_weights.detach();
    int inside = 0;
    for (std::int64_t r = 0; r < 8; ++r) {
      const auto heaviest =
          torch::argmax(weights.slice(0, 64 * r, 64 * (r + 1))).item<std::int64_t>();
      const float* const edges = &out.coarse_edges[65 * r + heaviest];
      for (std::int64_t i = 16 * r; i < 16 * (r + 1); ++i) {
        inside += out.samples.t[i] >= edges[0] && out.samples.t[i] <= edges[1];
      }
    }
    return inside;
  };
  EXPECT_GT(share_in_heaviest(1.0), 2 * std::max(1, share_in_heaviest(0.0)));
}

}  // namespace
}  // namespace nerf
