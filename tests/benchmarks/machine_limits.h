#pragma once

#include <cstdint>
#include <span>

namespace nerf::benchmarks {

// What this machine can do at most, at the highest SIMD level it has: the measure of the kernels.

// Independent fused multiply-adds in registers. Returns a number that depends on all of them.
//   operations  set to the floating-point operations done (2 a lane and multiply-add)
float FusedMultiplyAdds(std::int64_t repeats, std::int64_t& operations);

// Sums the 16-byte entries at the given places of a table, as a hash encoding of 4 features reads
// them, but with no arithmetic to find the places.
float SumEntries(std::span<const float> table, std::span<const std::uint32_t> entries);

}  // namespace nerf::benchmarks
