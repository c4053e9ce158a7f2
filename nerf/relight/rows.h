#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "nerf/field/libtorch.h"

namespace nerf {

// [P,3] float, a row for each vector.
inline torch::Tensor RowsOf(const std::vector<Eigen::Vector3f>& vectors) {
  torch::Tensor rows = torch::empty({static_cast<std::int64_t>(vectors.size()), 3});
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    std::copy_n(vectors[i].data(), 3, rows.data_ptr<float>() + 3 * i);
  }
  return rows;
}

}  // namespace nerf
