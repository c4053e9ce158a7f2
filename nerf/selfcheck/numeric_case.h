#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace nerf {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A hard case of the arithmetic: a claim, and how far from it this machine computes. The tests hold
// each to its bound on every SIMD level; `nerf selfcheck` does so where a person is.
struct NumericCase {
  std::string name;   // the claim, as a test is named: ThinFogKeepsItsOpacity
  std::string error;  // what is measured: "opacity, relative"
  double bound = 0;   // the largest error that is right
  bool simd = false;  // whether vector instructions take part
  std::function<double()> measure;
};

std::vector<NumericCase> CompositingCases();
std::vector<NumericCase> CompositingGradientCases();
std::vector<NumericCase> SamplingCases();
std::vector<NumericCase> EncodingCases();
std::vector<NumericCase> NetworkCases();
std::vector<NumericCase> CameraCases();
std::vector<NumericCase> EngineCases();

// The largest size of the errors it is told; one that is no number counts as infinite.
class WorstError {
 public:
  void Add(double error) {
    if (!(std::fabs(error) <= worst_)) worst_ = std::isnan(error) ? Infinity() : std::fabs(error);
  }
  // |value - truth| as a part of the truth, of `floor` where the truth is smaller.
  void AddRelative(long double value, long double truth, long double floor = 0) {
    const long double size = std::max(std::fabs(truth), floor);
    const long double error = std::fabs(value - truth);
    Add(static_cast<double>(error == 0 ? 0 : error / size));
  }
  // For claims that hold or not.
  void Require(bool holds) { Add(holds ? 0.0 : Infinity()); }
  void RequireFinite(double value) { Require(std::isfinite(value)); }

  double Get() const { return worst_; }

 private:
  static double Infinity() { return std::numeric_limits<double>::infinity(); }
  double worst_ = 0;
};

}  // namespace nerf
