#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace nerf {

// What a lens does to the ideal image plane, with every COLMAP 3.8 model as a special case.
// Source: COLMAP src/base/camera_models.h; the FOV model is Devernay and Faugeras 2001.
//
// A point m of the ideal plane lies at tan(angle to the axis) for perspective lenses and at the
// angle itself (radians) for fisheye lenses. The lens moves it, with s = |m|^2, to
//   m N(s)/D(s)  +  tangential (p1, p2)  +  thin prism (sx, sy) s
// Where `fov_omega` is set, atan(2 |m| tan(omega / 2)) / omega takes the place of |m| N/D.
struct LensDistortion {
  bool is_fisheye = false;
  std::array<double, 5> numerator{1, 0, 0, 0, 0};  // coefficients of s^0, s^1, ...
  std::array<double, 4> denominator{1, 0, 0, 0};
  Eigen::Vector2d tangential{0, 0};  // p1, p2
  Eigen::Vector2d prism{0, 0};       // sx1, sy1
  std::optional<double> fov_omega;   // radians
};

// Where the lens moves a point of the ideal plane.
//   returns  nullopt beyond the lens' reach: past the radius where the polynomial first stops
//   growing
//            (the image would fold over itself there), or more than 180 degrees off a fisheye's
//            axis
std::optional<Eigen::Vector2d> DistortedFromIdeal(const LensDistortion& lens,
                                                  const Eigen::Vector2d& ideal);

// The inverse, by Newton's method with an analytic Jacobian.
//   returns  nullopt where no ideal point within reach lands within 1e-11 (relative above 1)
std::optional<Eigen::Vector2d> IdealFromDistorted(const LensDistortion& lens,
                                                  const Eigen::Vector2d& distorted);

}  // namespace nerf
