#pragma once

#include <optional>

#include "nerf/data/mask.h"

namespace nerf {

// Photographs whose exposure or white balance differ (Exposure).
struct ExposureOptions {};

// Surroundings without end, behind everything, that differ in each direction (Background).
struct BackgroundOptions {
  // Rows of the map; it has twice as many columns. Few photographs look into one direction: of a
  // finer map each paints its own part, with what stands before the background in it (16 was best
  // of 8, 16, 32 and 128 on a photograph for validation).
  int resolution = 16;

  void Check() const;
};

// Light that a surface sends into one direction and not into another: gloss, mirrors. Without it
// the colour network does not see the direction.
struct ViewOptions {};

// What stands in a photograph or two and in no other: passers-by, shadows that move. A ray's loss l
// counts as l / (1 + l / scale), so that a large one, which nothing can make small, pulls little.
// Source: Geman and McClure 1985.
struct RobustOptions {
  double scale = 0.05;  // the loss of a ray whose pull is a quarter of what it was, in the end

  // At the beginning every ray is wrong, and those that are the most wrong have the most to tell:
  // the scale falls from a hundred times as much, along a power, until half of the training is
  // over.
  //   progress  in [0, 1]
  RobustOptions At(double progress) const;

  void Check() const;
};

// Distances of sparse points, for captures of few photographs (nerf/effects/depth.h).
struct DepthOptions {
  double share = 0.1;   // of the rays, which go through points
  double weight = 0.1;  // of their distances' loss against that of colours
  double delta = 0.1;   // relative error that costs half of the most

  void Check() const;
};

// Poses and focal lengths that are a little wrong (nerf/effects/poses.h).
struct PosesOptions {
  double rate = 0.05;  // of learning, in radians and normalized units, for each unit of the field's

  void Check() const;
};

// Pixels that see much of a surface or little of it, where cameras stand near and far
// (nerf/effects/footprint.h).
struct FootprintOptions {
  // The width of what a pixel averages; 0: a point. More than one, for a sample in the middle of a
  // pixel stands for all of it: 4 was best of 1, 2, 4 and 8 on photographs for validation, with 8.
  double pixels = 4;

  void Check() const;
};

// Matter beyond what the cameras look at, to any distance. Without it rays are cut to the unit ball
// about the scene, in which nothing is contracted.
struct UnboundedOptions {};

// The effects that a scene may call for, in the order in which light meets them. A block that is
// there is an effect that is simulated; one that is not there costs nothing.
struct EffectsOptions {
  std::optional<PosesOptions> poses;
  std::optional<UnboundedOptions> unbounded = UnboundedOptions();
  std::optional<FootprintOptions> footprint;
  std::optional<ViewOptions> view = ViewOptions();
  std::optional<BackgroundOptions> background;
  std::optional<ExposureOptions> exposure;
  std::optional<MaskOptions> masks;
  std::optional<RobustOptions> robust;
  std::optional<DepthOptions> depth;

  void Check() const;
};

}  // namespace nerf
