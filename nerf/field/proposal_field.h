#pragma once

#include <memory>

#include "nerf/field/hash_encoding.h"
#include "nerf/field/libtorch.h"
#include "nerf/field/mlp.h"
#include "nerf/sampling/proposal_options.h"

namespace nerf {

// The proposal network: a small density field by whose weights rays are resampled for the radiance
// field. It is trained to bound the weights of the radiance field. Source: Barron et al. 2022,
// "Mip-NeRF 360".
//
// Its weights are raised to an exponent before resampling (Annealing::proposal): 0 spaces samples
// evenly, 1 follows the weights. Training begins with 0, because an untrained network has no
// information.
class ProposalField : public torch::nn::Module {
 public:
  ProposalField(const ProposalOptions& options, std::uint64_t seed);

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
