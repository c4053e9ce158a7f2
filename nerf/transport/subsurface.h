#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "nerf/geometry/shapes.h"
#include "nerf/material/dipole.h"

namespace nerf {

// Subsurface scattering in a translucent sphere: irradiance at evenly spread points is convolved
// with the dipole and interpolated between them. The dipole is derived for a plane; here its
// distances are straight lines between points of the sphere. Source: Jensen and Buhler 2002,
// without their hierarchy, as there are few points.
class SubsurfaceSphere {
 public:
  SubsurfaceSphere(const Sphere& sphere, const Medium& medium);

  // Radiant exitance at the points, under some illumination.
  class Exitance {
   public:
    // Radiant exitance at a point of the sphere, below the boundary, W / m^2.
    Color At(const Eigen::Vector3d& x_in_world) const;
    // Radiance towards a viewer: exitance F_t(n . w_o) / pi.
    Color Radiance(const Eigen::Vector3d& x_in_world, double n_dot_v) const;

   private:
    friend class SubsurfaceSphere;
    std::shared_ptr<const SubsurfaceSphere> sphere_;
    std::vector<Color> values_;
  };

  // Computes the exitance.
  //   irradiance  below the boundary at point i, at x with unit normal n: the integral of
  //               F_t(n . w) L(w) n . w over the hemisphere; called from several threads
  static Exitance Illuminate(std::shared_ptr<const SubsurfaceSphere> sphere,
                             const std::function<Color(int i, const Eigen::Vector3d& x_in_world,
                                                       const Eigen::Vector3d& normal)>& irradiance);

  const Dipole& dipole() const { return dipole_; }
  // Exitance under a uniform irradiance of 1.
  Color UniformReflectance() const;

 private:
  Sphere sphere_;
  Dipole dipole_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<Eigen::Array3f> spread_;  // [to][from] R_d dA
};

}  // namespace nerf
