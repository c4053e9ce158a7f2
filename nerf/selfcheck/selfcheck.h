#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "nerf/selfcheck/numeric_case.h"

namespace nerf {

// All cases, from the volume-rendering integral to the engines.
std::vector<NumericCase> NumericCases();

// The error of a case at one SIMD level.
struct CaseResult {
  const NumericCase* numeric_case = nullptr;
  std::string level;  // "AVX3", "AVX2", ...; empty for cases without vector code
  double error = 0;

  bool Passed() const { return error <= numeric_case->tolerance.bound; }  // false for NaN
};

// Measures every case, those with vector code at every SIMD level of this processor.
//   done  called after each case with the number of cases measured
std::vector<CaseResult> MeasureCases(const std::vector<NumericCase>& cases,
                                     const std::function<void(std::int64_t)>& done);

}  // namespace nerf
