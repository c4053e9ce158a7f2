#pragma once

#include <Eigen/Core>
#include <string>

#include "nerf/image/image.h"

namespace nerf {

// The outline of a mirroring ball in a picture, in orthographic projection.
struct BallOutline {
  Eigen::Vector2d center;  // pixels; centres of pixels lie at +0.5
  double radius = 0;       // pixels
};

// The outline of a ball from its mask: the centre of mass, and the radius of a disc of equal area.
//   mask   the ball is where the first channel is above 0.5
//   name   of the file of the mask, for messages
// Throws InputError if the mask is empty, less than 10 pixels wide, or not a disc.
BallOutline FindBall(const Image& mask, const std::string& name);

// The direction to the light that a mirroring ball reflects: l = 2 (n . v) n - v, with the normal n
// of the ball at the highlight and v = (0, 0, 1). The highlight is the centre of mass of the pixels
// that are connected with the brightest pixel in the outline and more than half as bright.
//   photo    linear, 3 channels
//   name     of the file, for messages
//   returns  unit; x right, y up, z towards the camera
// Throws InputError naming the file if the ball is black or has no highlight.
Eigen::Vector3d LightFromHighlight(const Image& photo, const BallOutline& ball,
                                   const std::string& name);

}  // namespace nerf
