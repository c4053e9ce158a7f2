#pragma once

#include "nerf/field/libtorch.h"
#include "nerf/kernels/hash_encoding.h"

namespace nerf {

// The table of a multi-resolution hash encoding and the encoding as an autograd operation.
class HashEncoding : public torch::nn::Module {
 public:
  // The table starts uniform in +-1e-4 from `seed`.
  HashEncoding(const kernels::HashGridOptions& options, std::uint64_t seed);

  // positions  [N,3] in the unit cube, contiguous
  // returns    [N, levels * features]
  // Differentiable in the table, not in the positions.
  torch::Tensor forward(const torch::Tensor& positions);

  const kernels::HashGridLayout& Layout() const { return layout_; }
  const torch::Tensor& Table() const { return table_; }

 private:
  kernels::HashGridLayout layout_;
  torch::Tensor table_;  // [entries, features]
};

}  // namespace nerf
