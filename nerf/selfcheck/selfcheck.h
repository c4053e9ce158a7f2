#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "nerf/selfcheck/numeric_case.h"

namespace nerf {

// All of them, from the integral to the engines.
std::vector<NumericCase> NumericCases();

// A case as it came out at one SIMD level.
struct CaseResult {
  const NumericCase* numeric_case = nullptr;
  std::string level;  // "AVX3", "AVX2", ...; empty where no vector instructions take part
  double error = 0;

  bool Passed() const { return error <= numeric_case->bound; }  // not where it is no number
};

// Measures every case, at every SIMD level that this processor has where it has vector code.
//   done  called after each with the number of cases measured
std::vector<CaseResult> MeasureCases(const std::vector<NumericCase>& cases,
                                     const std::function<void(std::int64_t)>& done);

}  // namespace nerf
