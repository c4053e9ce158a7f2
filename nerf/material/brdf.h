#pragma once

#include <Eigen/Core>
#include <optional>

#include "nerf/image/color.h"

namespace nerf {

// A direction drawn for light to come from.
struct BrdfSample {
  Eigen::Vector3d w_i;  // unit, z > 0
  Color f = Color::Zero();
  double pdf = 0;  // 1 / sr, > 0
};

// Bidirectional reflectance distribution function f_r(w_o, w_i) = dL_r / dE_i, in 1 / sr
// (Nicodemus 1965). Directions are unit, point away from the surface, and stand in its frame: z is
// the normal, so n . w = w.z. Light from below, or seen from below, is not reflected.
class Brdf {
 public:
  virtual ~Brdf() = default;

  // f_r; 0 unless both directions are above the surface. Reciprocal: Eval(a, b) == Eval(b, a).
  virtual Color Eval(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const = 0;

  // Draws w_i, more or less as f_r cos(theta_i) asks.
  //   u        uniform in [0,1)^3
  //   returns  nullopt where the draw lies below the surface, which counts as 0
  virtual std::optional<BrdfSample> Sample(const Eigen::Vector3d& w_o,
                                           const Eigen::Array3d& u) const = 0;

  // The density with which Sample draws w_i, 1 / sr.
  virtual double Pdf(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const = 0;
};

}  // namespace nerf
