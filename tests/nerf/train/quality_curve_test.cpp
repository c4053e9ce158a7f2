#include "nerf/train/quality_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "nerf/base/atomic_file.h"

namespace nerf {
namespace {

using Recorded = std::vector<std::pair<double, double>>;  // seconds, PSNR

// Runs of the three presets on the fox, the chair and the built-in sample (scripts/bench --runs).
std::vector<Recorded> RecordedCurves() {
  const auto json = nlohmann::json::parse(ReadWholeFile(NERF_RECORDED_CURVES));
  std::vector<Recorded> curves;
  for (const auto& curve : json) curves.push_back(curve.get<Recorded>());
  return curves;
}

QualityCurve CurveOf(const Recorded& points, std::size_t count) {
  QualityCurve curve;
  for (std::size_t i = 0; i < count; ++i) curve.Add(points[i].first, points[i].second);
  return curve;
}

// The mean of a point and its neighbours: single validations vary by some tenths of a decibel.
double Smoothed(const Recorded& points, std::size_t i) {
  const std::size_t begin = i > 0 ? i - 1 : 0, end = std::min(points.size(), i + 2);
  double sum = 0;
  for (std::size_t k = begin; k < end; ++k) sum += points[k].second;
  return sum / static_cast<double>(end - begin);
}

double ShareWithin(const std::vector<double>& errors, double bound) {
  const auto within = std::ranges::count_if(errors, [bound](double e) { return e <= bound; });
  return static_cast<double>(within) / static_cast<double>(errors.size());
}

TEST(QualityCurve, PredictsTheTimeOfTheNextHalfDecibelWithinAFactorOfThree) {
  std::vector<double> factors;
  for (const Recorded& points : RecordedCurves()) {
    for (std::size_t i = 3; i + 1 < points.size(); ++i) {
      const double target = Smoothed(points, i) + 0.5;
      std::size_t reached = i;
      while (reached < points.size() && Smoothed(points, reached) < target) ++reached;
      if (reached == points.size()) continue;
      const double measured = points[reached].first - points[i].first;
      const double predicted = *CurveOf(points, i + 1).SecondsForNext(0.5);
      factors.push_back(std::max(predicted / measured, measured / predicted));
    }
  }
  ASSERT_GT(factors.size(), 80u);
  EXPECT_GE(ShareWithin(factors, 3), 0.8);
  EXPECT_GE(ShareWithin(factors, 1.7), 0.5);
}

TEST(QualityCurve, PredictsTheFinalPsnrWithinFourTenthsOfADecibel) {
  std::vector<double> errors;
  for (const Recorded& points : RecordedCurves()) {
    const double end = points.back().first;
    for (std::size_t i = 3; i + 1 < points.size(); ++i) {
      if (points[i].first < 0.3 * end) continue;
      errors.push_back(
          std::fabs(*CurveOf(points, i + 1).PsnrAt(end) - Smoothed(points, points.size() - 1)));
    }
  }
  ASSERT_GT(errors.size(), 100u);
  EXPECT_GE(ShareWithin(errors, 0.4), 0.8);
}

TEST(QualityCurve, FitsALineOverTheLogarithmOfTime) {
  QualityCurve curve;
  for (const double t : {10.0, 20.0, 40.0, 80.0}) curve.Add(t, 20 + std::log2(t / 10));
  EXPECT_EQ(curve.Last(), 23);
  EXPECT_NEAR(*curve.SecondsOfLast(1), 40, 1e-9);
  EXPECT_NEAR(*curve.SecondsOfLast(0.5), 20, 1e-9);
  // 0.7 of the slope: 0.7 dB per octave.
  EXPECT_NEAR(*curve.PsnrAt(160), 23.7, 1e-9);
  EXPECT_NEAR(*curve.SecondsForNext(0.7), 80, 1e-9);
}

TEST(QualityCurve, PredictsNothingFromTooFewPoints) {
  QualityCurve curve;
  EXPECT_FALSE(curve.Last() || curve.SecondsOfLast(0.5) || curve.SecondsForNext(0.5));
  curve.Add(10, 20);
  curve.Add(20, 20.2);
  EXPECT_FALSE(curve.SecondsOfLast(0.5) || curve.PsnrAt(30));  // improved by less than 0.5 dB
}

TEST(QualityCurve, PredictsNoGainForAFallingCurve) {
  QualityCurve curve;
  for (int i = 1; i <= 8; ++i) curve.Add(10 * i, 30 - 0.1 * i);
  EXPECT_EQ(curve.SecondsForNext(0.5), std::numeric_limits<double>::infinity());
  EXPECT_LE(*curve.PsnrAt(1000), 30);
}

TEST(QualityCurve, IgnoresInvalidPoints) {
  QualityCurve curve;
  const double inf = std::numeric_limits<double>::infinity();
  for (const auto& [t, psnr] : Recorded{{0, 20}, {-1, 20}, {1, inf}, {inf, 1}, {1, std::nan("")}}) {
    curve.Add(t, psnr);
  }
  EXPECT_FALSE(curve.Last());
  curve.Add(2, 21);
  curve.Add(2, 25);  // seconds do not increase
  EXPECT_EQ(curve.Last(), 21);
}

}  // namespace
}  // namespace nerf
