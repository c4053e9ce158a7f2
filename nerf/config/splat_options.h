#pragma once

#include "nerf/base/options.h"

namespace nerf {

// How Gaussians are fitted to photographs (nerf/splats/gaussian_fit.h).
struct SplatOptions {
  int count = 0;
  int steps = 4000;
  double share = 0.8;
  int harmonics_order = 3;
  double structural = 0.3;
  double quarter_resolution = 0.25;
  double half_resolution = 0.7;
  double split_until = 0.7;
  int split_every = 50;
  double split_share = 0.05;
  double least_opacity = 0.02;
  double opacity_penalty = 0.02;
  double mean_rate = 6e-3;
  double scale_rate = 2.4e-2;
  double rotation_rate = 1.2e-2;
  double opacity_rate = 0.06;
  double color_rate = 1.2e-2;
  double harmonics_rate = 1.2e-3;
  double last_rate = 0.1;
  double last_mean_rate = 0.01;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("count", o.count, "", Between(0, 1 << 24),
           "Gaussians; 0: by the size of photographs and the time, 50000 up to 400x400 pixels");
    option("steps", o.steps, "iterations", Between(1, 1 << 24), "without a time budget");
    option("share", o.share, "of a time budget", Between(0.1, 0.9),
           "in which nerf train fits Gaussians, after the field");
    option("harmonics_order", o.harmonics_order, "", Between(0, 3),
           "of the spherical harmonics by which colour depends on direction");
    option("structural", o.structural, "", Between(0, 1), "share of 1 - SSIM in the loss");
    option("quarter_resolution", o.quarter_resolution, "of the training", Between(0, 1),
           "at first, at a quarter of the resolution; longer for photographs above 400x400 pixels");
    option("half_resolution", o.half_resolution, "of the training", Between(0, 1),
           "until then, at half the resolution; longer for photographs above 400x400 pixels");
    option("split_until", o.split_until, "of the training", Between(0, 1),
           "until then invisible Gaussians split others");
    option("split_every", o.split_every, "iterations", Between(1, 1 << 20), "between two splits");
    option("split_share", o.split_share, "of the Gaussians", Between(0, 1),
           "at most, split at a time");
    option("least_opacity", o.least_opacity, "", Between(0, 1), "below it a Gaussian is invisible");
    option("opacity_penalty", o.opacity_penalty, "of the loss", AtLeast(0),
           "on the opacity of each Gaussian");
    option("mean_rate", o.mean_rate, "normalized units", AtLeast(0),
           "learning rate of positions, in a fit of 2000 iterations; others: by the root of their "
           "number");
    option("scale_rate", o.scale_rate, "", AtLeast(0), "of the logarithms of sizes");
    option("rotation_rate", o.rotation_rate, "", AtLeast(0), "of rotations");
    option("opacity_rate", o.opacity_rate, "", AtLeast(0), "of opacities before the sigmoid");
    option("color_rate", o.color_rate, "", AtLeast(0), "of colours");
    option("harmonics_rate", o.harmonics_rate, "", AtLeast(0), "of the higher harmonics");
    option("last_rate", o.last_rate, "", AboveUpTo(0, 1),
           "learning rates at the end, of the first");
    option("last_mean_rate", o.last_mean_rate, "", AboveUpTo(0, 1), "of positions at the end");
  }
};

}  // namespace nerf
