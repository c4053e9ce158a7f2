#include "nerf/reference/descriptor_matching.h"

#include <numeric>

namespace nerf::reference {

std::vector<kernels::NearestTwo> FindNearestTwo(std::span<const std::uint8_t> a,
                                                std::span<const std::uint8_t> b) {
  constexpr std::size_t kSize = kernels::kDescriptorSize;
  std::vector<kernels::NearestTwo> nearest(a.size() / kSize);
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    for (std::size_t j = 0; j < b.size() / kSize; ++j) {
      const int product =
          std::inner_product(&a[i * kSize], &a[i * kSize] + kSize, &b[j * kSize], 0);
      if (product > nearest[i].product) {
        nearest[i] = {static_cast<int>(j), product, nearest[i].product};
      } else if (product > nearest[i].second_product) {
        nearest[i].second_product = product;
      }
    }
  }
  return nearest;
}

}  // namespace nerf::reference
