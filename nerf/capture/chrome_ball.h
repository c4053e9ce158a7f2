#pragma once

#include <Eigen/Core>
#include <string>

#include "nerf/image/image.h"

namespace nerf {

// Where a mirroring ball stands in a picture, seen from far away (orthographic).
struct BallOutline {
  Eigen::Vector2d center;  // pixels; centres of pixels lie at +0.5
  double radius = 0;       // pixels
};

// The outline of a ball from its mask: centre of mass and radius of a disc of the same area.
//   mask   3 channels; what is above 0.5 in the first belongs to the ball
//   name   of the mask's file, for messages
// Throws InputError where the mask is empty, smaller than 10 pixels across, or no disc.
BallOutline FindBall(const Image& mask, const std::string& name);

// The direction towards the light whose highlight a mirroring ball shows: l = 2 (n . v) n - v, with
// n the ball's normal at the highlight and v = (0, 0, 1). The highlight is the centre of mass of
// what is brighter than half of the brightest pixel within the outline, joined to that pixel.
//   photo    linear, 3 channels
//   returns  unit; x to the right of the picture, y up, z towards the camera
// Throws InputError, naming the file, where the ball is black or no pixel stands out.
Eigen::Vector3d LightFromHighlight(const Image& photo, const BallOutline& ball,
                                   const std::string& name);

}  // namespace nerf
