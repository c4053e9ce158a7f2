#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "nerf/kernels/simd_level.h"

namespace nerf::kernels {

inline void PrintTo(const SimdLevel& level, std::ostream* out) { *out << level.name; }

}  // namespace nerf::kernels

namespace nerf::test {

// Runs a test once per SIMD level that this machine supports and the program was compiled for.
class EverySimdLevel : public testing::TestWithParam<kernels::SimdLevel> {
 private:
  kernels::WithSimdLevel level_{GetParam()};
};

inline std::string SimdLevelName(const testing::TestParamInfo<kernels::SimdLevel>& info) {
  return info.param.name;
}

}  // namespace nerf::test

#define NERF_FOR_EVERY_SIMD_LEVEL(suite)                                                       \
  INSTANTIATE_TEST_SUITE_P(SimdLevel, suite, testing::ValuesIn(::nerf::kernels::SimdLevels()), \
                           ::nerf::test::SimdLevelName)
