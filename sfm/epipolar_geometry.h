#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace nerf::sfm {

// Where one point is seen in two photographs, pixels.
struct PointPair {
  Eigen::Vector2d first, second;
};

// The squared distance of a pair from one that fits the fundamental matrix, x2^T F x1 = 0, to first
// order, squared pixels (Hartley and Zisserman, "Multiple View Geometry", 11.4.3).
double SquaredSampsonError(const Eigen::Matrix3d& fundamental, const PointPair& pair);

// The fundamental matrices, one or three, of seven pairs (section 11.1.2). None where the pairs are
// degenerate.
std::vector<Eigen::Matrix3d> FundamentalOfSeven(std::span<const PointPair> pairs);

// The fundamental matrix of least squares of eight or more pairs (section 11.2). None where the
// pairs are degenerate.
std::optional<Eigen::Matrix3d> FundamentalOfMany(std::span<const PointPair> pairs);

struct EpipolarOptions {
  double max_error = 4;  // pixels; these four figures are those of COLMAP's verification
  double confidence = 0.999;
  double min_inlier_ratio = 0.25;
  int min_inliers = 15;
  int max_trials = 3000;
};

// The geometry of two photographs that most pairs agree with.
struct EpipolarGeometry {
  Eigen::Matrix3d fundamental = Eigen::Matrix3d::Zero();
  std::vector<int> inliers;  // indices of pairs, ascending
};

// Finds it by RANSAC with local optimization (Chum et al. 2003). The same pairs and seed give the
// same result.
//   returns  nothing where fewer pairs agree than the options ask for
std::optional<EpipolarGeometry> FitEpipolarGeometry(std::span<const PointPair> pairs,
                                                    const EpipolarOptions& options,
                                                    std::uint32_t seed);

}  // namespace nerf::sfm
