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
  double dark = 0.002;      // observations below this fraction of the brightest are in shadow
  double tolerance = 0.08;  // of the robust method: residuals above this fraction of the brightest
                            // observation are shadows or highlights
  double max_residual = 0.02;  // relative to the albedo; kAuto uses the robust method if least
                               // squares exceed it or an observation is in shadow
  int max_triples = 400;       // of lights, tried by the robust method

  // Throws InputError, naming the option, if a value is out of range.
  void Check() const;
};

// The diffuse surface at a pixel.
struct SurfaceEstimate {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit; x right, y up, z towards the camera
  double albedo = 0;    // in the unit of the observations; 0 if there is no solution
  double residual = 0;  // root mean square of the residuals, divided by the albedo
  bool robust = false;  // solved by the robust method
};

// Normals from the brightness under known lights: b_i = albedo max(0, l_i . n).
// Least squares: Woodham 1980, (L^T L) g = L^T b with g = albedo n, over all lights.
// Robust: the exact solutions of triples of lights are compared, and the one with the lowest
// truncated squared error is kept, the sum of min(r^2, tolerance^2) (MSAC, Torr and Zisserman
// 2000); then least squares over the lit observations, weighted by the biweight of Beaton and Tukey
// 1974, which is 0 beyond two tolerances. The model includes attached shadows (lights behind the
// surface); cast shadows and highlights are outliers.
class PhotometricSolver {
 public:
  // Throws InputError if there are fewer than three lights, or they are in one plane with the
  // subject (the smallest singular value of L is below 2 % of the largest): the component of the
  // normal perpendicular to that plane cannot be observed then.
  PhotometricSolver(std::span<const DirectionalLight> lights, const StereoOptions& options);

  //   observations  brightness under each light, divided by its intensity; negative: unknown
  //                 (saturated)
  //   returns       an estimate that faces the camera (z > 0), or one with albedo 0 if there is no
  //                 solution: fewer than three observations are known and lit, or the least-squares
  //                 solution faces away
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
