#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace nerf::kernels {

// A set of vector instructions that this processor has and for which the kernels were compiled.
struct SimdLevel {
  std::int64_t target = 0;  // Highway's number
  std::string name;         // "AVX3", "AVX2", "SSE4", ...
};

// Best first; the kernels use the first one by default.
std::vector<SimdLevel> SimdLevels();

// While it exists, all threads use this level. Only one may exist, and it must not be created or
// destroyed while kernels run.
class WithSimdLevel {
 public:
  explicit WithSimdLevel(const SimdLevel& level);
  ~WithSimdLevel();
  WithSimdLevel(const WithSimdLevel&) = delete;
  WithSimdLevel& operator=(const WithSimdLevel&) = delete;
};

}  // namespace nerf::kernels
