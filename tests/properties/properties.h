#pragma once

#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <vector>

// Generators of the values of hostile or unlucky inputs, for property-based tests.
namespace nerf::test {

// 0 or more, over all magnitudes: zero, denormal, ordinary, FLT_MAX.
inline rc::Gen<float> AnyLength() {
  return rc::gen::oneOf(
      rc::gen::element(0.0f, 1e-45f, 1e-38f, 1e-10f, 1.0f, 1e10f, 1e30f,
                       std::numeric_limits<float>::max()),
      rc::gen::map(rc::gen::inRange(-60, 60), [](int k) { return std::ldexp(1.0f, k); }),
      rc::gen::map(rc::gen::inRange(0, 1 << 20),
                   [](int k) { return static_cast<float>(k) * 1e-5f; }));
}

// In [0,1].
inline rc::Gen<float> Fraction() {
  return rc::gen::map(rc::gen::inRange(0, 1 << 24), [](int k) {
    return static_cast<float>(k) / static_cast<float>((1 << 24) - 1);
  });
}

inline rc::Gen<std::vector<float>> VectorOf(std::size_t count, const rc::Gen<float>& element) {
  return rc::gen::container<std::vector<float>>(count, element);
}

}  // namespace nerf::test
