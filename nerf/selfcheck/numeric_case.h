#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace nerf {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

// One rounding error of a value of size 1: of float, and of double.
inline constexpr double kFloatRounding = std::numeric_limits<float>::epsilon();
inline constexpr double kDoubleRounding = std::numeric_limits<double>::epsilon();

// How large the error of a case may be. The bound follows the error: it is at most ten times the
// largest error measured when it was set, at any SIMD level, and so notices a small fault; or four
// rounding errors where that is more, so that another processor's rounding does not fail it.
struct Tolerance {
  double measured = 0;               // largest error measured when `bound` was set
  double bound = 0;                  // largest error that passes
  double rounding = kFloatRounding;  // one rounding error, in the unit of the case

  double LargestAllowedBound() const { return std::max(10 * measured, 4 * rounding); }
};
constexpr Tolerance Within(double bound, double measured, double rounding = kFloatRounding) {
  return {measured, bound, rounding};
}
inline constexpr Tolerance kExact = {};  // of a claim that holds or does not

// A numerically hard case: a claim, and how far this processor's results are from it. The tests
// hold each case to its bound on every SIMD level; `nerf selfcheck` does so on a user's machine.
struct NumericCase {
  std::string name;      // the claim, named like a test: ThinFogKeepsItsOpacity
  std::string quantity;  // what the error measures: "opacity, relative"
  Tolerance tolerance;
  bool simd = false;  // whether it runs vector code, so that it is measured at every SIMD level
  std::function<double()> measure;  // returns the error
};

std::vector<NumericCase> CompositingCases();
std::vector<NumericCase> CompositingGradientCases();
std::vector<NumericCase> SamplingCases();
std::vector<NumericCase> EncodingCases();
std::vector<NumericCase> NetworkCases();
std::vector<NumericCase> CameraCases();
std::vector<NumericCase> EngineCases();
std::vector<NumericCase> GaussianCases();
std::vector<NumericCase> ShadingCases();
std::vector<NumericCase> ShadowCases();

// The largest absolute value of the errors added; NaN counts as infinite.
class WorstError {
 public:
  void Add(double error) {
    if (!(std::fabs(error) <= worst_)) worst_ = std::isnan(error) ? Infinity() : std::fabs(error);
  }
  // |value - truth| relative to |truth|, or to `floor` where |truth| is smaller.
  void AddRelative(long double value, long double truth, long double floor = 0) {
    const long double size = std::max(std::fabs(truth), floor);
    const long double error = std::fabs(value - truth);
    Add(static_cast<double>(error == 0 ? 0 : error / size));
  }
  // For claims that hold or do not: an infinite error where they do not.
  void Require(bool holds) { Add(holds ? 0.0 : Infinity()); }
  void RequireFinite(double value) { Require(std::isfinite(value)); }

  double Get() const { return worst_; }

 private:
  static double Infinity() { return std::numeric_limits<double>::infinity(); }
  double worst_ = 0;
};

}  // namespace nerf
