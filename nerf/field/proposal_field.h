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

  // positions [S,3] in the unit cube -> [S], 1 / normalized scene unit. Differentiable in the
  // parameters.
  torch::Tensor Density(const torch::Tensor& positions);

  // The exponent, in [0,1], that the weights get before intervals are cut by them: 0 spreads
  // samples evenly, 1 follows the weights. A new field knows nothing, and is trusted step by step.
  void SetTrust(double trust);
  double Trust() const { return trust_; }

  const HashEncoding& Hash() const { return *hash_encoding_; }
  const Mlp& Network() const { return *network_; }

 private:
  double trust_ = 1;
  std::shared_ptr<HashEncoding> hash_encoding_;
  std::shared_ptr<Mlp> network_;
};

}  // namespace nerf
