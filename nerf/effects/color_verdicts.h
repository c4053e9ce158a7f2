#pragma once

#include <vector>

#include "nerf/inspect/photograph_fit.h"
#include "nerf/inspect/track_colors.h"
#include "nerf/inspect/verdict.h"

namespace nerf {

// What the colours of points call for, over the photographs that see them.

// Fewer points say too little.
inline constexpr std::size_t kFewestPoints = 50;

// The share of points whose colour changes from view to view by more than an error of a pixel, or
// another slant, could change it in their texture. Undecided where few points are seen often.
Verdict JudgeView(const TrackColors& colors, const PhotographFit& fit);

// How far exposures are from each other.
//   stops  of each photograph against the mean, one at least
//   where  says what shows them
Verdict JudgeExposure(const std::vector<double>& stops, const char* where);

// The share of places where a point should be seen and something else is: effect "robust".
Verdict JudgePassers(const TrackColors& colors, const PhotographFit& fit);

}  // namespace nerf
