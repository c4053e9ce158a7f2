#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace nerf {

// A lens distortion model of which every COLMAP 3.8 model is a special case.
// Source: COLMAP src/base/camera_models.h; the FOV model is Devernay and Faugeras 2001.
//
// A point m of the ideal image plane is at the radius tan(angle to the axis) for perspective lenses
// and at the angle itself (radians) for fisheye lenses. It is distorted, with s = |m|^2, to
//   m N(s)/D(s)  +  tangential (p1, p2)  +  thin prism (sx, sy) s
// Where `fov_omega` is set, atan(2 |m| tan(omega / 2)) / omega replaces |m| N/D.
struct LensDistortion {
  bool is_fisheye = false;
  std::array<double, 5> numerator{1, 0, 0, 0, 0};  // coefficients of s^0, s^1, ...
  std::array<double, 4> denominator{1, 0, 0, 0};
  Eigen::Vector2d tangential{0, 0};  // p1, p2
  Eigen::Vector2d prism{0, 0};       // sx1, sy1
  std::optional<double> fov_omega;   // radians
};

// Distorts a point of the ideal plane.
//   returns  nullopt outside the valid range of the model: beyond the radius at which the
//            polynomial stops increasing, where the image would fold over itself, or more than 180
//            degrees off the axis of a fisheye
std::optional<Eigen::Vector2d> DistortedFromIdeal(const LensDistortion& lens,
                                                  const Eigen::Vector2d& ideal);

// The inverse, by Newton's method with an analytic Jacobian, accurate to 1e-11 (relative above 1).
//   returns  nullopt where no point in the valid range was found
std::optional<Eigen::Vector2d> IdealFromDistorted(const LensDistortion& lens,
                                                  const Eigen::Vector2d& distorted);

}  // namespace nerf
