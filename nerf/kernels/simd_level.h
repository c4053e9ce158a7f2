#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace nerf::kernels {

// A set of vector instructions that the kernels were compiled for and this processor has.
struct SimdLevel {
  std::int64_t target = 0;  // Highway's number
  std::string name;         // "AVX3", "AVX2", "SSE4", ...
};

// Best first; what the kernels use by themselves is the first.
std::vector<SimdLevel> SimdLevels();

// While it lives, all threads use that level. One at a time, and not while kernels run.
class WithSimdLevel {
 public:
  explicit WithSimdLevel(const SimdLevel& level);
  ~WithSimdLevel();
  WithSimdLevel(const WithSimdLevel&) = delete;
  WithSimdLevel& operator=(const WithSimdLevel&) = delete;
};

}  // namespace nerf::kernels
