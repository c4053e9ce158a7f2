#pragma once

#include <Eigen/Core>
#include <optional>

#include "nerf/image/color.h"

namespace nerf {

// A sampled direction of incident light.
struct BrdfSample {
  Eigen::Vector3d w_i;  // unit, z > 0
  Color f = Color::Zero();
  double pdf = 0;  // 1 / sr, > 0
};

// Bidirectional reflectance distribution function f_r(w_o, w_i) = dL_r / dE_i, in 1 / sr
// (Nicodemus 1965). Directions are unit vectors away from the surface, in its frame: z is the
// normal, so that n . w = w.z. Nothing is reflected if either direction is below the surface.
class Brdf {
 public:
  virtual ~Brdf() = default;

  // f_r. Reciprocal: Eval(a, b) == Eval(b, a).
  virtual Color Eval(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const = 0;

  // Draws w_i with a density roughly proportional to f_r cos(theta_i).
  //   u        uniform in [0,1)^3
  //   returns  nullopt if the direction is below the surface; it counts as a sample of 0
  virtual std::optional<BrdfSample> Sample(const Eigen::Vector3d& w_o,
                                           const Eigen::Array3d& u) const = 0;

  // The density of Sample, 1 / sr.
  virtual double Pdf(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const = 0;
};

}  // namespace nerf
