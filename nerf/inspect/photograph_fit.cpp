#include "nerf/inspect/photograph_fit.h"

namespace nerf {
namespace {

// Rounds of ordinary means, then of means that count what is far off less.
constexpr int kPlainRounds = 10, kRobustRounds = 40;

// Log light, below which what is left over counts as a square.
constexpr float kSmall = 0.01f;

// Moves what a group's sightings leave over in the mean into the group's part.
void TakeMeans(std::span<const Sighting> sightings, int Sighting::*group, bool robust,
               std::vector<Eigen::Vector3f>& part, std::vector<Eigen::Vector3f>& left_over) {
  std::vector<Eigen::Vector3f> sum(part.size(), Eigen::Vector3f::Zero());
  std::vector<Eigen::Vector3f> weights = sum;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const Eigen::Array3f size = left_over[i].array().abs().max(kSmall);
    Eigen::Array3f weight = Eigen::Array3f::Ones();
    if (robust) weight = size.inverse();
    sum[sightings[i].*group] += (weight * left_over[i].array()).matrix();
    weights[sightings[i].*group] += weight.matrix();
  }
  for (std::size_t g = 0; g < part.size(); ++g) {
    if (weights[g].x() == 0) continue;
    sum[g] = sum[g].cwiseQuotient(weights[g]);
    part[g] += sum[g];
  }
  for (std::size_t i = 0; i < sightings.size(); ++i) left_over[i] -= sum[sightings[i].*group];
}

}  // namespace

PhotographFit FitPhotographs(std::span<const Sighting> sightings, std::size_t points,
                             std::size_t photographs) {
  PhotographFit fit;
  fit.of_point.assign(points, Eigen::Vector3f::Zero());
  fit.of_photograph.assign(photographs, Eigen::Vector3f::Zero());
  for (const Sighting& s : sightings) fit.left_over.push_back(s.log_light);
  for (int round = 0; round < kPlainRounds + kRobustRounds; ++round) {
    const bool robust = round >= kPlainRounds;
    TakeMeans(sightings, &Sighting::point, robust, fit.of_point, fit.left_over);
    TakeMeans(sightings, &Sighting::photograph, robust, fit.of_photograph, fit.left_over);
  }
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const auto& part : fit.of_photograph) mean += part / static_cast<float>(photographs);
  for (auto& part : fit.of_photograph) part -= mean;
  for (auto& part : fit.of_point) part += mean;
  return fit;
}

}  // namespace nerf
