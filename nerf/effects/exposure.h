#pragma once

#include <string>
#include <vector>

#include "nerf/effects/effect.h"

namespace nerf {

// Photographs whose exposure or white balance differ: a gain for each photograph and channel
// (nerf/field/exposure.h).
struct ExposureOptions {
  template <class Self, class Visitor>
  static void Options(Self&, Visitor&&) {}
};

// How far exposures are from each other.
//   stops   of each photograph against the mean, log2 of light; one at least
//   source  says what shows them
Verdict JudgeExposure(const std::vector<double>& stops, const std::string& source);

extern const EffectDescriptor kExposure;

}  // namespace nerf
