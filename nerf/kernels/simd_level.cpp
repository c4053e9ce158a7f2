#include "nerf/kernels/simd_level.h"

#include <hwy/targets.h>

namespace nerf::kernels {

std::vector<SimdLevel> SimdLevels() {
  std::vector<SimdLevel> levels;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    levels.push_back({target, hwy::TargetName(target)});
  }
  return levels;
}

WithSimdLevel::WithSimdLevel(const SimdLevel& level) {
  hwy::SetSupportedTargetsForTest(level.target);
}

WithSimdLevel::~WithSimdLevel() { hwy::SetSupportedTargetsForTest(0); }

}  // namespace nerf::kernels
