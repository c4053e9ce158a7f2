#include "nerf/effects/color_verdicts.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "nerf/inspect/angle_residuals.h"

namespace nerf {
namespace {

constexpr std::size_t kFewestViews = 5;  // of a point; fewer say too little

// A normal distribution's standard deviation over its median absolute value.
constexpr double kDeviationOfMedian = 1.48;

// From which on a scene calls for an effect.
constexpr double kExposureStops = 0.1;   // standard deviation over the photographs
constexpr double kViewDependent = 0.12;  // share of points
constexpr double kPassing = 0.007;       // share of sightings that show something else
constexpr double kSomethingElse = 0.35;  // log light, and four times what is usual

double Luminance(const Eigen::Vector3f& log_light) { return static_cast<double>(log_light.mean()); }

}  // namespace

Verdict JudgeView(const TrackColors& colors, const PhotographFit& fit) {
  struct Spread {
    std::vector<double> left_over, contrast;
  };
  std::map<int, Spread> of_point;
  for (std::size_t i = 0; i < colors.seen.size(); ++i) {
    Spread& spread = of_point[colors.seen[i].point];
    spread.left_over.push_back(std::fabs(Luminance(fit.residuals[i])));
    spread.contrast.push_back(static_cast<double>(colors.seen[i].contrast));
  }
  std::size_t judged = 0, changing = 0;
  for (auto& [point, spread] : of_point) {
    if (spread.left_over.size() < kFewestViews) continue;
    ++judged;
    const double change = kDeviationOfMedian * Quantile(spread.left_over, 0.5);
    if (change > kTexturelessVariation + Quantile(spread.contrast, 0.5)) ++changing;
  }
  if (judged < kFewestPoints) {
    return Undecided(
        "view", fmt::format("only {} points are seen {} times and more", judged, kFewestViews));
  }
  const double share = static_cast<double>(changing) / static_cast<double>(judged);
  return Measured("view", share, kViewDependent,
                  fmt::format("the colour of {:.1f} % of the points changes with the view by more "
                              "than their texture explains; {:.0f} % call for it",
                              100 * share, 100 * kViewDependent));
}

Verdict JudgeExposure(const std::vector<double>& stops, const char* where) {
  double squares = 0, largest = 0;
  for (const double s : stops) {
    squares += s * s;
    largest = std::max(largest, std::fabs(s));
  }
  const double spread = std::sqrt(squares / static_cast<double>(stops.size()));
  return Measured("exposure", spread, kExposureStops,
                  fmt::format("photographs differ by {:.2f} stops ({:.2f} at most) {}; {:.2f} "
                              "call for it",
                              spread, largest, where, kExposureStops));
}

Verdict JudgePassers(const TrackColors& colors, const PhotographFit& fit) {
  std::vector<double> usual;
  for (const auto& left : fit.residuals) usual.push_back(std::fabs(Luminance(left)));
  const double noise = kDeviationOfMedian * Quantile(usual, 0.5);
  const double limit = std::max(kSomethingElse, 4 * noise);
  std::size_t other = 0;
  for (const Sighting& s : colors.unseen) {
    const Eigen::Vector3f left =
        s.log_light - fit.of_point[s.point] - fit.of_photograph[s.photograph];
    if (static_cast<double>(left.cwiseAbs().maxCoeff()) > limit) ++other;
  }
  const double share = static_cast<double>(other) /
                       static_cast<double>(std::max<std::size_t>(1, colors.seen.size() + other));
  return Measured("robust", share, kPassing,
                  fmt::format("in {:.1f} % of the places where a point should be seen stands "
                              "something else; {:.1f} % call for it",
                              100 * share, 100 * kPassing));
}

}  // namespace nerf
