#include "nerf/scene/representative_cameras.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace nerf {
namespace {

constexpr int kMostSwapRounds = 20;
constexpr std::size_t kMostCompared = 2000;  // of more cameras, an even subset

// [N,N] between cameras.
Eigen::MatrixXd Distances(const std::vector<Eigen::Isometry3d>& cameras) {
  const auto n = static_cast<Eigen::Index>(cameras.size());
  Eigen::Matrix3Xd position(3, n), axis(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    position.col(i) = cameras[i].translation();
    axis.col(i) = cameras[i].linear().col(2);
  }
  const Eigen::Vector3d center = position.rowwise().mean();
  const double spread = (position.colwise() - center).colwise().norm().mean();
  Eigen::MatrixXd distances(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::RowVectorXd apart = (position.colwise() - position.col(i)).colwise().norm();
    const Eigen::RowVectorXd turned = (axis.colwise() - axis.col(i)).colwise().norm();
    distances.row(i) = (spread > 0 ? apart / spread : apart) + turned;
  }
  return distances;
}

// Puts the camera into chosen[k] for which the sum of the distances to the nearest chosen camera is
// least; whether that changed it.
bool Improve(const Eigen::MatrixXd& distances, std::vector<std::size_t>& chosen, std::size_t k) {
  const auto row = [&](std::size_t i) { return distances.row(static_cast<Eigen::Index>(i)); };
  Eigen::RowVectorXd to_others =
      Eigen::RowVectorXd::Constant(distances.cols(), std::numeric_limits<double>::infinity());
  for (std::size_t other = 0; other < chosen.size(); ++other) {
    if (other != k) to_others = to_others.cwiseMin(row(chosen[other]));
  }
  const std::size_t before = chosen[k];
  double least = to_others.cwiseMin(row(before)).sum();
  for (std::size_t i = 0; i < static_cast<std::size_t>(distances.cols()); ++i) {
    if (std::ranges::find(chosen, i) != chosen.end()) continue;
    const double cost = to_others.cwiseMin(row(i)).sum();
    if (cost < least) {
      least = cost;
      chosen[k] = i;
    }
  }
  return chosen[k] != before;
}

// Of the cameras that are nearest to the chosen one, that in the middle of their distances: the
// chosen one itself has the most neighbours, so that its view is the easiest.
std::size_t TypicalOf(const Eigen::MatrixXd& distances, const std::vector<std::size_t>& chosen,
                      std::size_t k) {
  std::vector<std::pair<double, std::size_t>> group;
  for (std::size_t i = 0; i < static_cast<std::size_t>(distances.cols()); ++i) {
    const auto to_chosen = [&](std::size_t other) {
      return distances(static_cast<Eigen::Index>(other), static_cast<Eigen::Index>(i));
    };
    const bool is_chosen = std::ranges::find(chosen, i) != chosen.end();
    const std::size_t nearest = *std::ranges::min_element(chosen, {}, to_chosen);
    if (is_chosen ? i == chosen[k] : nearest == chosen[k])
      group.emplace_back(to_chosen(chosen[k]), i);
  }
  std::ranges::sort(group);
  return group[group.size() / 2].second;
}

}  // namespace

std::vector<std::size_t> RepresentativeCameras(
    const std::vector<Eigen::Isometry3d>& world_from_camera, std::size_t count) {
  if (count == 0) return {};
  if (world_from_camera.size() > kMostCompared) {
    const std::size_t step = (world_from_camera.size() + kMostCompared - 1) / kMostCompared;
    std::vector<Eigen::Isometry3d> some;
    for (std::size_t i = 0; i < world_from_camera.size(); i += step) {
      some.push_back(world_from_camera[i]);
    }
    std::vector<std::size_t> chosen = RepresentativeCameras(some, count);
    for (std::size_t& index : chosen) index *= step;
    return chosen;
  }
  const Eigen::MatrixXd distances = Distances(world_from_camera);
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k) {
    std::size_t any = 0;  // that is not chosen
    while (std::ranges::find(chosen, any) != chosen.end()) ++any;
    chosen.push_back(any);
    Improve(distances, chosen, k);
  }
  bool changed = true;
  for (int round = 0; changed && round < kMostSwapRounds; ++round) {
    changed = false;
    for (std::size_t k = 0; k < count; ++k) changed = Improve(distances, chosen, k) || changed;
  }
  std::vector<std::size_t> typical;
  for (std::size_t k = 0; k < count; ++k) typical.push_back(TypicalOf(distances, chosen, k));
  std::ranges::sort(typical);
  return typical;
}

}  // namespace nerf
