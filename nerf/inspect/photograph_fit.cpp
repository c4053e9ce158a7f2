#include "nerf/inspect/photograph_fit.h"

namespace nerf {
namespace {

// Rounds with ordinary means, then with means that are weighted against outliers.
constexpr int kPlainRounds = 10, kRobustRounds = 40;

// Residuals in log light below which the loss is quadratic and not absolute.
constexpr float kQuadraticBelow = 0.01f;

// Moves the mean residual of each group (the sightings of one point or one photograph) into the
// group's part of the fit.
void MoveMeans(std::span<const Sighting> sightings, int Sighting::*group, bool robust,
               std::vector<Eigen::Vector3f>& part, std::vector<Eigen::Vector3f>& residuals) {
  std::vector<Eigen::Vector3f> sum(part.size(), Eigen::Vector3f::Zero());
  std::vector<Eigen::Vector3f> weights = sum;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const Eigen::Array3f size = residuals[i].array().abs().max(kQuadraticBelow);
    Eigen::Array3f weight = Eigen::Array3f::Ones();
    if (robust) weight = size.inverse();
    sum[sightings[i].*group] += (weight * residuals[i].array()).matrix();
    weights[sightings[i].*group] += weight.matrix();
  }
  for (std::size_t g = 0; g < part.size(); ++g) {
    if (weights[g].x() == 0) continue;
    sum[g] = sum[g].cwiseQuotient(weights[g]);
    part[g] += sum[g];
  }
  for (std::size_t i = 0; i < sightings.size(); ++i) residuals[i] -= sum[sightings[i].*group];
}

}  // namespace

PhotographFit FitPhotographs(std::span<const Sighting> sightings, std::size_t points,
                             std::size_t photographs) {
  PhotographFit fit;
  fit.of_point.assign(points, Eigen::Vector3f::Zero());
  fit.of_photograph.assign(photographs, Eigen::Vector3f::Zero());
  for (const Sighting& s : sightings) fit.residuals.push_back(s.log_light);
  for (int round = 0; round < kPlainRounds + kRobustRounds; ++round) {
    const bool robust = round >= kPlainRounds;
    MoveMeans(sightings, &Sighting::point, robust, fit.of_point, fit.residuals);
    MoveMeans(sightings, &Sighting::photograph, robust, fit.of_photograph, fit.residuals);
  }
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const auto& part : fit.of_photograph) mean += part / static_cast<float>(photographs);
  for (auto& part : fit.of_photograph) part -= mean;
  for (auto& part : fit.of_point) part += mean;
  return fit;
}

}  // namespace nerf
