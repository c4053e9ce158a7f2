#include "nerf/selfcheck/selfcheck.h"

#include "nerf/kernels/simd_level.h"

namespace nerf {

std::vector<NumericCase> NumericCases() {
  std::vector<NumericCase> cases;
  for (const auto& of_one_layer :
       {CompositingCases, CompositingGradientCases, SamplingCases, EncodingCases, NetworkCases,
        CameraCases, EngineCases, GaussianCases, ShadingCases, ShadowCases}) {
    for (NumericCase& numeric_case : of_one_layer()) cases.push_back(std::move(numeric_case));
  }
  return cases;
}

std::vector<CaseResult> MeasureCases(const std::vector<NumericCase>& cases,
                                     const std::function<void(std::int64_t)>& done) {
  std::vector<CaseResult> results;
  std::int64_t measured = 0;
  for (const NumericCase& numeric_case : cases) {
    if (numeric_case.simd) {
      for (const kernels::SimdLevel& level : kernels::SimdLevels()) {
        const kernels::WithSimdLevel at(level);
        results.push_back({&numeric_case, level.name, numeric_case.measure()});
      }
    } else {
      results.push_back({&numeric_case, "", numeric_case.measure()});
    }
    done(++measured);
  }
  return results;
}

}  // namespace nerf
