#include "nerf/capture/photometric_stereo.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "nerf/base/input_error.h"
#include "nerf/base/random.h"

namespace nerf {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kCoplanar = 0.02;        // smallest over largest singular value
constexpr double kMinDeterminant = 1e-4;  // of a triple of unit directions
constexpr int kRefits = 8;
constexpr double kBiweightRadius = 2;  // of the biweight, in tolerances

SurfaceEstimate EstimateFrom(const Vector3d& g) {
  SurfaceEstimate estimate;
  const double albedo = g.norm();
  if (!(albedo > 0)) return estimate;
  estimate.albedo = albedo;
  estimate.normal = g / albedo;
  return estimate;
}

// Weighted normal equations, accumulated one observation at a time.
struct NormalEquations {
  Matrix3d LtL = Matrix3d::Zero();
  Vector3d Ltb = Vector3d::Zero();
  int count = 0;

  void Add(const Vector3d& light, double b, double weight = 1) {
    LtL += weight * light * light.transpose();
    Ltb += weight * b * light;
    ++count;
  }
  // Zero if the lights do not span space.
  Vector3d Solve() const {
    if (count < 3) return Vector3d::Zero();
    const Eigen::LDLT<Matrix3d> factors(LtL);
    if (factors.vectorD().minCoeff() < 1e-9 * count) return Vector3d::Zero();
    return factors.solve(Ltb);
  }
};

}  // namespace

void StereoOptions::Check() const {
  if (!(dark >= 0 && dark < 1)) throw InputError("--dark is {}: choose 0 to 1", dark);
  if (!(tolerance > 0)) throw InputError("--tolerance is {}: choose above 0", tolerance);
  if (!(max_residual >= 0)) {
    throw InputError("--residual is {}: choose 0 or more", max_residual);
  }
  if (max_triples < 1) throw InputError("--triples is {}: choose 1 or more", max_triples);
}

PhotometricSolver::PhotometricSolver(std::span<const DirectionalLight> lights,
                                     const StereoOptions& options)
    : lights_(lights.size(), 3), options_(options) {
  options.Check();
  const int n = static_cast<int>(lights.size());
  if (n < 3) {
    throw InputError("{} lights: normals need three or more lights that are not in one plane", n);
  }
  for (int i = 0; i < n; ++i) lights_.row(i) = lights[i].to_light;
  const Vector3d spread = Eigen::JacobiSVD<Eigen::MatrixXd>(lights_).singularValues();
  if (spread.z() < kCoplanar * spread.x()) {
    throw InputError("the {} lights are in one plane with the subject; move one out of it", n);
  }
  const auto add = [&](int i, int j, int k) {
    Matrix3d L;
    L << lights_.row(i), lights_.row(j), lights_.row(k);
    if (std::abs(L.determinant()) >= kMinDeterminant) triples_.push_back({{i, j, k}, L.inverse()});
  };
  if (std::int64_t{n} * (n - 1) * (n - 2) / 6 <= options.max_triples) {
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) {
        for (int k = j + 1; k < n; ++k) add(i, j, k);
      }
    }
    return;
  }
  for (std::uint64_t draw = 0; draw < 10 * static_cast<std::uint64_t>(options.max_triples);
       ++draw) {
    if (std::ssize(triples_) == options.max_triples) break;
    const auto light = [&](std::uint64_t corner) {
      return static_cast<int>(RandomBelow(static_cast<std::uint32_t>(n), 1, corner, draw));
    };
    add(light(0), light(1), light(2));  // the determinant is 0 if a light is drawn twice
  }
}

SurfaceEstimate PhotometricSolver::Solve(std::span<const double> observations) const {
  if (options_.method == StereoMethod::kRobust) return Robust(observations);
  const SurfaceEstimate plain = LeastSquares(observations);
  if (options_.method == StereoMethod::kLeastSquares) return plain;
  const double brightest = *std::ranges::max_element(observations);
  const bool in_shadow = std::ranges::any_of(
      observations, [&](double b) { return b >= 0 && b <= options_.dark * brightest; });
  const bool explained = plain.albedo > 0 && !in_shadow && plain.residual <= options_.max_residual;
  return explained ? plain : Robust(observations);
}

SurfaceEstimate PhotometricSolver::LeastSquares(std::span<const double> observations) const {
  NormalEquations equations;
  for (int i = 0; i < lights_.rows(); ++i) {
    if (observations[i] >= 0) equations.Add(lights_.row(i), observations[i]);
  }
  const Vector3d g = equations.Solve();
  // Visible surfaces face the camera. Another result means that the model does not fit; flipping
  // the normal would not make it right.
  if (g.z() <= 0) return {};
  SurfaceEstimate estimate = EstimateFrom(g);
  double squares = 0;
  for (int i = 0; i < lights_.rows(); ++i) {
    if (observations[i] < 0) continue;
    const double r = observations[i] - std::max(0.0, lights_.row(i).dot(g));
    squares += r * r;
  }
  if (estimate.albedo > 0) {
    estimate.residual = std::sqrt(squares / equations.count) / estimate.albedo;
  }
  return estimate;
}

SurfaceEstimate PhotometricSolver::Robust(std::span<const double> observations) const {
  std::vector<int> known;
  double brightest = 0;
  for (int i = 0; i < lights_.rows(); ++i) {
    if (observations[i] < 0) continue;
    known.push_back(i);
    brightest = std::max(brightest, observations[i]);
  }
  const double dark = options_.dark * brightest;
  if (known.size() < 3 || !(brightest > 0)) return {};

  const auto residual = [&](const Vector3d& g, int i) {
    return observations[i] - std::max(0.0, lights_.row(i).dot(g));
  };
  const double tolerance = options_.tolerance * brightest;
  double lowest_cost = std::numeric_limits<double>::infinity();
  Vector3d g = Vector3d::Zero();
  for (const Triple& triple : triples_) {
    const auto [i, j, k] = triple.lights;
    if (observations[i] <= dark || observations[j] <= dark || observations[k] <= dark) continue;
    const Vector3d candidate =
        triple.g_from_b * Vector3d(observations[i], observations[j], observations[k]);
    if (candidate.z() <= 0) continue;  // visible surfaces face the camera
    double sum = 0;
    for (const int light : known) {
      const double r = residual(candidate, light);
      sum += std::min(r * r, tolerance * tolerance);
    }
    if (sum < lowest_cost) lowest_cost = sum, g = candidate;
  }
  if (!(lowest_cost < std::numeric_limits<double>::infinity())) return {};

  // Refit all observations that agree, with smoothly decreasing weights.
  const double radius = kBiweightRadius * tolerance;
  for (int refit = 0; refit < kRefits; ++refit) {
    NormalEquations equations;
    for (const int i : known) {
      const double r = residual(g, i) / radius;
      if (std::abs(r) >= 1 || observations[i] <= dark || lights_.row(i).dot(g) <= 0) continue;
      equations.Add(lights_.row(i), observations[i], (1 - r * r) * (1 - r * r));
    }
    const Vector3d refitted = equations.Solve();
    if (refitted.z() <= 0) break;  // no solution, or facing away
    g = refitted;
  }
  double sum = 0;
  int agreeing = 0;
  for (const int i : known) {
    const double r = residual(g, i);
    if (std::abs(r) > tolerance) continue;
    sum += r * r;
    ++agreeing;
  }
  SurfaceEstimate estimate = EstimateFrom(g);
  estimate.robust = true;
  if (estimate.albedo > 0 && agreeing > 0) {
    estimate.residual = std::sqrt(sum / agreeing) / estimate.albedo;
  }
  return estimate;
}

}  // namespace nerf
