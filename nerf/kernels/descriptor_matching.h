#pragma once

#include <cstdint>
#include <span>

namespace nerf::kernels {

// Numbers in a SIFT descriptor.
inline constexpr int kDescriptorSize = 128;

// Of all descriptors of another set, those with the largest scalar products with one descriptor.
struct NearestTwo {
  std::int32_t index = -1;  // of the nearest; -1 if all products are 0
  std::int32_t product = 0, second_product = 0;

  bool operator==(const NearestTwo&) const = default;
};

// Compares each descriptor of A with each of B, in one thread. Descriptors of one length have the
// smallest angle where their scalar product is largest. Exact, so that all SIMD levels agree; which
// of several nearest ones with the same product is returned is unspecified.
//   a, b  [count][kDescriptorSize]
//   of_a  [count of a]: the nearest two in B of each descriptor of A
//   of_b  [count of b]: the nearest two in A of each descriptor of B
void FindNearestTwo(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b,
                    std::span<NearestTwo> of_a, std::span<NearestTwo> of_b);

}  // namespace nerf::kernels
