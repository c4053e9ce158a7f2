#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "nerf/light/lights.h"

namespace nerf {

enum class StereoMethod { kLeastSquares, kRobust, kAuto };

struct StereoOptions {
  StereoMethod method = StereoMethod::kAuto;
  double dark = 0.002;      // observations below this share of a pixel's brightest lie in shadow
  double tolerance = 0.08;  // of the robust method: residuals above this share of the brightest are
                            // shadows and highlights
  double largest_residual = 0.02;  // relative to the albedo: where least squares leaves more, or
                                   // a light leaves the pixel in shadow, `auto` is robust
  int most_triples = 400;          // of lights that the robust method tries

  // Throws InputError, naming the option, where a value is out of range.
  void Check() const;
};

// A matt surface seen at one pixel.
struct SurfaceEstimate {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit; x right, y up, z towards the camera
  double albedo = 0;    // of the observations' unit; 0 where nothing could be said
  double residual = 0;  // root of the mean squared difference to max(0, l . n), over the albedo
  bool robust = false;  // which method gave it
};

// Normals from brightness under known lights: b_i = albedo max(0, l_i . n).
// Sources: Woodham 1980, least squares over all lights, (L^T L) g = L^T b with g = albedo n;
// robust: sample consensus with truncated squares (MSAC of Torr and Zisserman 2000): of the exact
// solutions of all triples of lights that face the camera the one with the least sum of
// min(r^2, tolerance^2), then least squares over the lit observations weighted by the biweight of
// Beaton and Tukey 1974, which is 0 from two tolerances on. A light behind the surface explains
// darkness, so attached shadows agree with the model; cast shadows and highlights are left out.
class PhotometricSolver {
 public:
  // Throws InputError where there are fewer than three lights, or they lie in a plane with the
  // subject (the smallest singular value of L under 2 % of the largest): then the normal's part
  // across that plane cannot be seen.
  PhotometricSolver(std::span<const DirectionalLight> lights, const StereoOptions& options);

  // observations  brightness under each light, divided by its intensity; a negative value marks one
  //               that is not known (saturated)
  // Every normal faces the camera (z > 0), for what is seen does.
  // Leaves the normal at z and the albedo 0 where nothing can be said: fewer than three
  // observations are known and lit, or least squares alone turn the normal away from the camera.
  SurfaceEstimate Solve(std::span<const double> observations) const;

 private:
  using Matrix = Eigen::Matrix<double, 3, 3>;
  struct Triple {
    std::array<int, 3> lights;
    Matrix g_from_b;
  };

  SurfaceEstimate LeastSquares(std::span<const double> observations) const;
  SurfaceEstimate Robust(std::span<const double> observations) const;

  Eigen::Matrix<double, Eigen::Dynamic, 3> lights_;  // a row each, unit
  StereoOptions options_;
  std::vector<Triple> triples_;
};

}  // namespace nerf
