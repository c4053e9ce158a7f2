#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "nerf/geometry/shapes.h"
#include "nerf/material/dipole.h"

namespace nerf {

// Light through a translucent sphere: its irradiance at points spread evenly over it, spread by the
// dipole, looked up anywhere in between. The dipole's plane is bent onto the sphere; distances are
// straight. Source: Jensen and Buhler 2002, without their hierarchy: there are few points.
class SubsurfaceSphere {
 public:
  SubsurfaceSphere(const Sphere& sphere, const Medium& medium);

  // Radiant exitance at the points, and how to look it up.
  class Exitance {
   public:
    // Light that leaves at a point of the sphere, W / m^2, before its boundary.
    Color At(const Eigen::Vector3d& x_in_world) const;
    // Radiance towards a viewer: exitance F_t(n . w_o) / pi.
    Color Radiance(const Eigen::Vector3d& x_in_world, double n_dot_v) const;

   private:
    friend class SubsurfaceSphere;
    std::shared_ptr<const SubsurfaceSphere> sphere_;
    std::vector<Color> values_;
  };

  // The dipole's share of irradiance.
  //   irradiance  at point i, at x with unit normal n: integral of F_t(n . w) L(w) n . w over the
  //               hemisphere; called from several threads
  static Exitance Light(std::shared_ptr<const SubsurfaceSphere> sphere,
                        const std::function<Color(int i, const Eigen::Vector3d& x_in_world,
                                                  const Eigen::Vector3d& normal)>& irradiance);

  const Dipole& dipole() const { return dipole_; }
  // Sum of a point's row: exitance under uniform irradiance of 1.
  Color UniformReflectance() const;

 private:
  Sphere sphere_;
  Dipole dipole_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<Eigen::Array3f> spread_;  // [to][from] R_d dA
};

}  // namespace nerf
