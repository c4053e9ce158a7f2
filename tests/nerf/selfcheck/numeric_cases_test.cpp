#include <gtest/gtest.h>

#include <set>

#include "nerf/kernels/simd_level.h"
#include "nerf/selfcheck/selfcheck.h"

namespace nerf {
namespace {

// A case at a level.
struct Trial {
  NumericCase numeric_case;
  kernels::SimdLevel level;
};

void PrintTo(const Trial& trial, std::ostream* out) { *out << trial.numeric_case.quantity; }

std::vector<Trial> Trials() {
  std::vector<Trial> trials;
  for (const NumericCase& numeric_case : NumericCases()) {
    for (const kernels::SimdLevel& level : kernels::SimdLevels()) {
      trials.push_back({numeric_case, level});
      if (!numeric_case.simd) break;
    }
  }
  return trials;
}

class Numerics : public testing::TestWithParam<Trial> {};

TEST_P(Numerics, StayWithinTheirBound) {
  const auto& [numeric_case, level] = GetParam();
  const kernels::WithSimdLevel at(level);
  EXPECT_LE(numeric_case.measure(), numeric_case.tolerance.bound);
}

INSTANTIATE_TEST_SUITE_P(HardCase, Numerics, testing::ValuesIn(Trials()), [](const auto& test) {
  const Trial& trial = test.param;
  return trial.numeric_case.name + (trial.numeric_case.simd ? "_" + trial.level.name : "");
});

// Compares recorded numbers alone, so that it holds on every processor.
TEST(NumericCases, HaveBoundsOfAtMostTenTimesTheErrorMeasuredOrAFewRoundings) {
  for (const NumericCase& numeric_case : NumericCases()) {
    const Tolerance& tolerance = numeric_case.tolerance;
    EXPECT_LE(tolerance.bound, tolerance.LargestAllowedBound()) << numeric_case.name;
    EXPECT_LE(tolerance.measured, tolerance.bound) << numeric_case.name;
  }
}

TEST(Tolerance, AllowsTenTimesTheErrorOrFourRoundings) {
  EXPECT_DOUBLE_EQ(Within(1e-3, 1e-4).LargestAllowedBound(), 1e-3);
  EXPECT_DOUBLE_EQ(Within(0, 0).LargestAllowedBound(), 4 * kFloatRounding);
  EXPECT_DOUBLE_EQ(Within(0, 1e-17, kDoubleRounding).LargestAllowedBound(), 4 * kDoubleRounding);
}

TEST(Selfcheck, MeasuresVectorCodeAtEverySimdLevelAndFailsErrorsAboveTheBound) {
  const std::vector<NumericCase> cases = {
      {"Right", "nothing", kExact, false, [] { return 0.0; }},
      {"Vectors", "nothing", Within(1, 1), true, [] { return 1.0; }},
      {"Wrong", "nothing", Within(1, 1), false, [] { return 1.1; }},
      {"NaN", "nothing", Within(1, 1), false, [] { return std::nan(""); }}};
  std::int64_t measured = 0;
  const auto results = MeasureCases(cases, [&](std::int64_t n) { measured = n; });
  EXPECT_EQ(measured, 4);
  ASSERT_EQ(results.size(), 3 + kernels::SimdLevels().size());
  std::set<std::string> failed;
  for (const CaseResult& result : results) {
    if (!result.Passed()) failed.insert(result.numeric_case->name);
  }
  EXPECT_EQ(failed, (std::set<std::string>{"Wrong", "NaN"}));
}

TEST(WorstError, CountsNaNAsInfinite) {
  WorstError worst;
  worst.Add(0.5);
  worst.AddRelative(1.1L, 1.0L);
  EXPECT_EQ(worst.Get(), 0.5);
  worst.AddRelative(0.0L, 0.0L);
  EXPECT_EQ(worst.Get(), 0.5);
  worst.AddRelative(std::nan(""), 1.0L);
  EXPECT_TRUE(std::isinf(worst.Get()));
  worst.Add(0.1);
  EXPECT_TRUE(std::isinf(worst.Get()));
}

}  // namespace
}  // namespace nerf
