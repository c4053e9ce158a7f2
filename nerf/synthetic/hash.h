#pragma once

#include <cstdint>

namespace nerf::synthetic {

// Hashes of 32 bits for the textures and for all that is random about a generated capture. They
// stay beside the generator of nerf/base/random.h because every texture and camera, and so every
// pixel of the captures, is defined by them.

// Scrambles the bits of a word, so that similar inputs give unrelated outputs.
// Source: Wellons 2018, "Prospecting for Hash Functions" (lowbias32).
constexpr std::uint32_t Hash(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  x ^= x >> 16;
  return x;
}

// The hash of a cell of an integer lattice.
constexpr std::uint32_t Hash(int x, int y, int z, std::uint32_t seed) {
  return Hash((static_cast<std::uint32_t>(x) * 0x8da6b343U) ^
              (static_cast<std::uint32_t>(y) * 0xd8163841U) ^
              (static_cast<std::uint32_t>(z) * 0xcb1ab31fU) ^ (seed * 0x9e3779b9U));
}

// A hash as a number in [0, 1).
constexpr double UnitFromHash(std::uint32_t hash) { return hash * 0x1p-32; }

}  // namespace nerf::synthetic
