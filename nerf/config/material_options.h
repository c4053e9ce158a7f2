#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

#include "nerf/base/options.h"

namespace nerf {

// Whether an effect of light is simulated.
enum class LightEffectChoice { kAuto, kOn, kOff };

template <>
struct EnumNames<LightEffectChoice> {
  static constexpr std::pair<LightEffectChoice, std::string_view> kNames[] = {
      {LightEffectChoice::kAuto, "auto"},
      {LightEffectChoice::kOn, "on"},
      {LightEffectChoice::kOff, "off"}};
};

// How materials and light are found (nerf/train/material_fit.h).
struct MaterialOptions {
  double share = 0.3;
  std::int64_t steps = 2000;
  LightEffectChoice shadows = LightEffectChoice::kAuto;
  LightEffectChoice bounces = LightEffectChoice::kAuto;
  LightEffectChoice specular = LightEffectChoice::kAuto;
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
    option("share", o.share, "of a time budget", StrictlyBetween(0, 1),
           "for materials, after the field");
    option("steps", o.steps, "", AtLeast(1), "of the fit, without a time budget");
    option("shadows", o.shadows, "of the light on the surface; auto: where there are any");
    option("bounces", o.bounces, "light from surface to surface; auto: where it is worth it");
    option("specular", o.specular, "a coat that reflects, and metal; auto: by a trial");
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
