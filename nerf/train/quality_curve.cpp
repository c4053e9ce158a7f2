#include "nerf/train/quality_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nerf {
namespace {

constexpr std::size_t kFewestPoints = 4;
constexpr double kWindow = 0.25;               // the fit begins at this fraction of the time
constexpr double kPredictedSlopeFactor = 0.7;  // the curve flattens

}  // namespace

void QualityCurve::Add(double seconds, double psnr) {
  if (!(seconds > 0 && std::isfinite(seconds) && std::isfinite(psnr))) return;
  if (!points_.empty() && seconds <= points_.back().seconds) return;
  points_.push_back({seconds, psnr});
}

std::optional<double> QualityCurve::Last() const {
  if (points_.empty()) return {};
  return points_.back().psnr;
}

std::optional<double> QualityCurve::SecondsOfLast(double gain) const {
  if (points_.empty()) return {};
  const auto best = std::ranges::max_element(points_, {}, &Point::psnr);
  const double before = best->psnr - gain;
  const auto after = std::find_if(points_.begin(), best,
                                  [before](const Point& point) { return point.psnr >= before; });
  if (after == points_.begin()) return {};  // has not improved by that much
  const Point& from = *(after - 1);
  const double part = (before - from.psnr) / (after->psnr - from.psnr);
  return best->seconds - (from.seconds + part * (after->seconds - from.seconds));
}

std::optional<QualityCurve::Line> QualityCurve::Fit() const {
  if (points_.size() < kFewestPoints) return {};
  const double last = points_.back().seconds;
  auto begin = std::ranges::find_if(
      points_, [last](const Point& point) { return point.seconds >= kWindow * last; });
  if (points_.end() - begin < 3) begin = points_.end() - 3;
  const auto count = static_cast<double>(points_.end() - begin);
  double mean_x = 0, mean_y = 0;
  for (auto point = begin; point != points_.end(); ++point) {
    mean_x += std::log(point->seconds / last) / count;
    mean_y += point->psnr / count;
  }
  double covariance = 0, variance = 0;
  for (auto point = begin; point != points_.end(); ++point) {
    const double x = std::log(point->seconds / last) - mean_x;
    covariance += x * (point->psnr - mean_y);
    variance += x * x;
  }
  if (!(variance > 0)) return {};
  const double slope = covariance / variance;
  return Line{mean_y - slope * mean_x, slope};
}

std::optional<double> QualityCurve::SecondsForNext(double gain) const {
  const auto line = Fit();
  if (!line) return {};
  const double slope = kPredictedSlopeFactor * line->slope;
  if (!(slope > 0)) return std::numeric_limits<double>::infinity();
  return points_.back().seconds * std::expm1(gain / slope);
}

std::optional<double> QualityCurve::PsnrAt(double seconds) const {
  const auto line = Fit();
  if (!line) return {};
  return line->level + kPredictedSlopeFactor * std::max(0.0, line->slope) *
                           std::log(seconds / points_.back().seconds);
}

}  // namespace nerf
