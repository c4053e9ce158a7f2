#pragma once

#include <string>
#include <vector>

#include "nerf/effects/effect.h"

namespace nerf {

// Exposure compensation: a gain per photograph and channel, for photographs whose exposure or white
// balance differ (nerf/field/exposure.h).
struct ExposureOptions {
  template <class Self, class Visitor>
  static void Options(Self&, Visitor&&) {}
};

// Judges by the standard deviation of the exposures.
//   stops   exposure of each photograph relative to the mean, log2 of light; at least one
//   source  where they were measured, as a phrase of the evidence
Verdict JudgeExposure(const std::vector<double>& stops, const std::string& source);

extern const EffectDescriptor kExposureEffect;

}  // namespace nerf
