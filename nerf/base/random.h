#pragma once

#include <cstdint>

namespace nerf {

// Counter-based random numbers: each is a function of its coordinates (seed, stream, index), so
// that any thread can draw any of them and a resumed run draws the same ones again. The only state
// of the generator is the seed and the step. Source: the finaliser of SplitMix64 (Steele, Lea,
// Flood 2014) as a counter-based hash.
inline std::uint64_t Mix64(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

inline std::uint64_t RandomBits(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  return Mix64(Mix64(Mix64(seed) ^ stream) ^ index);
}

// Uniform in [0, 1), a multiple of 2^-24.
inline float RandomFloat(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  return static_cast<float>(RandomBits(seed, stream, index) >> 40) * 0x1p-24f;
}

// Uniform in {0, ..., bound - 1}; the bias of the multiplication method is below bound / 2^32.
inline std::uint32_t RandomBelow(std::uint32_t bound, std::uint64_t seed, std::uint64_t stream,
                                 std::uint64_t index) {
  return static_cast<std::uint32_t>(((RandomBits(seed, stream, index) >> 32) * bound) >> 32);
}

}  // namespace nerf
