#pragma once

#include <memory>

#include "nerf/field/hash_encoding.h"
#include "nerf/field/libtorch.h"
#include "nerf/field/mlp.h"
#include "nerf/sampling/proposal_options.h"

namespace nerf {

// A small density field that says where along a ray the large one should look. It learns no
// colours, only to stand wherever the weights of the large field do.
class ProposalField : public torch::nn::Module {
 public:
  ProposalField(const ProposalOptions& options, std::uint64_t seed);

  // Its weights are raised to an exponent before rays are resampled by them (Annealing::proposal):
  // 0 spreads samples evenly, 1 follows the weights. A new network knows nothing, so training
  // begins with 0.

  // positions [S,3] in the unit cube -> [S], 1 / normalized scene unit. Differentiable in the
  // parameters.
  torch::Tensor Density(const torch::Tensor& positions);

  const HashEncoding& Hash() const { return *hash_encoding_; }
  const Mlp& Network() const { return *network_; }

 private:
  std::shared_ptr<HashEncoding> hash_encoding_;
  std::shared_ptr<Mlp> network_;
};

}  // namespace nerf
