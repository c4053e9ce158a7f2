#pragma once

#include "nerf/field/libtorch.h"
#include "nerf/kernels/hash_encoding.h"

namespace nerf {

// A multiresolution hash encoding: its table, and the encoding as an autograd operation. Source:
// Mueller et al. 2022, "Instant Neural Graphics Primitives".
class HashEncoding : public torch::nn::Module {
 public:
  // The table is initialized uniformly in +-1e-4 from `seed`.
  HashEncoding(const kernels::HashGridOptions& options, std::uint64_t seed);

  //   positions  [N,3] in the unit cube, of the table's type
  //   returns    [N, levels * features]
  // Differentiable in the table and in the positions. Throws c10::Error on a shape or type
  // mismatch.
  torch::Tensor forward(const torch::Tensor& positions);

  const kernels::HashGridLayout& Layout() const { return layout_; }
  const torch::Tensor& Table() const { return table_; }

 private:
  kernels::HashGridLayout layout_;
  torch::Tensor table_;  // [entries, features]
};

}  // namespace nerf
