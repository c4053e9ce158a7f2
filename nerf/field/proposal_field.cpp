#include "nerf/field/proposal_field.h"

#include "nerf/base/random.h"
#include "nerf/field/density.h"

namespace nerf {

ProposalField::ProposalField(const ProposalOptions& options, std::uint64_t seed) {
  hash_encoding_ = register_module(
      "hash_encoding", std::make_shared<HashEncoding>(options.encoding, Mix64(seed + 3)));
  network_ = register_module(
      "network",
      std::make_shared<Mlp>(
          std::vector<std::int64_t>{hash_encoding_->Layout().OutputSize(), options.hidden_width, 1},
          Mix64(seed + 4)));
}

torch::Tensor ProposalField::Density(const torch::Tensor& positions) {
  const torch::Tensor out = network_->forward(hash_encoding_->forward(positions));
  return ActivateDensity(out.select(1, 0)) * RadialShrinkage(positions);
}

}  // namespace nerf
