#pragma once

#include "nerf/geometry/mesh.h"
#include "nerf/image/image.h"

namespace nerf {

// A height field as a mesh: a vertex for each pixel that has a height, two triangles between four
// neighbouring vertices, facing the camera.
//   height   1 channel, towards the camera, in pixels; NaN: no surface
//   color    3 channels of the same size, linear
// Axes: x right, y up, z towards the camera; the centre of the picture is x = y = 0; the unit is a
// pixel.
Mesh MeshFromHeights(const Image& height, const Image& color);

}  // namespace nerf
