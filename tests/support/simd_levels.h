#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>
#include <string>
#include <vector>

namespace nerf::test {

// Runs a test once for each SIMD level that this machine has and the program was compiled for.
class EverySimdLevel : public testing::TestWithParam<std::int64_t> {
 protected:
  EverySimdLevel() { hwy::SetSupportedTargetsForTest(GetParam()); }
  ~EverySimdLevel() override { hwy::SetSupportedTargetsForTest(0); }
};

inline std::vector<std::int64_t> SimdLevels() {
  std::vector<std::int64_t> levels;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) levels.push_back(target);
  return levels;
}

inline std::string SimdLevelName(const testing::TestParamInfo<std::int64_t>& info) {
  return hwy::TargetName(info.param);
}

}  // namespace nerf::test

#define NERF_FOR_EVERY_SIMD_LEVEL(suite)                                                    \
  INSTANTIATE_TEST_SUITE_P(SimdLevel, suite, testing::ValuesIn(::nerf::test::SimdLevels()), \
                           ::nerf::test::SimdLevelName)
