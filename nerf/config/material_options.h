#pragma once

#include "nerf/base/options.h"

namespace nerf {

// How materials and light are found (nerf/train/material_fit.h).
struct MaterialOptions {
  int surface_resolution = 160;
  int directions = 512;
  int points = 1024;
  double rate = 5e-3;
  double light_rate = 2e-2;
  double last_rate = 0.1;
  double smoothness = 0.01;
  double metal_penalty = 2e-3;
  double normal_penalty = 0.01;
  double normal_offset = 0.3;
  double white_light = 0.01;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("surface_resolution", o.surface_resolution, "cells", Between(16, 1024),
           "along the longest side of what is opaque");
    option("directions", o.directions, "", Between(16, 1 << 14), "from which light arrives");
    option("points", o.points, "of a step", Between(1, 1 << 20), "pixels that are shaded");
    option("rate", o.rate, "", AtLeast(0), "learning rate of the material field");
    option("light_rate", o.light_rate, "", AtLeast(0), "of the logarithms of radiance");
    option("last_rate", o.last_rate, "", AboveUpTo(0, 1),
           "learning rates at the end, of the first");
    option("smoothness", o.smoothness, "of the loss", AtLeast(0),
           "on relative differences between close points");
    option("metal_penalty", o.metal_penalty, "of the loss", AtLeast(0), "on the mean metallic");
    option("normal_penalty", o.normal_penalty, "of the loss", AtLeast(0),
           "on squared offsets of normals");
    option("normal_offset", o.normal_offset, "", Between(0, 1),
           "tangent of the angle that normals may turn");
    option("white_light", o.white_light, "of the loss", AtLeast(0),
           "on the mean light, to be white and of its usual brightness");
  }
};

}  // namespace nerf
