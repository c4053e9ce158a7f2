#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nerf/inspect/photograph_facts.h"
#include "nerf/inspect/photograph_fit.h"
#include "nerf/inspect/point_shares.h"
#include "nerf/inspect/track_colors.h"
#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// Fewer sparse points are not evidence of anything.
inline constexpr std::size_t kFewestPoints = 50;

// A normal distribution's standard deviation over its median absolute value.
inline constexpr double kDeviationOfMedian = 1.48;

// What is known of a capture before anything is trained; the effects judge by it.
struct CaptureEvidence {
  const PosedImages* posed = nullptr;
  PhotographFacts facts;
  SceneNormalization frame;          // NormalizeScene; the identity where poses are not known
  bool may_learn_background = true;  // else contracted space must hold what is far

  // Why colours and tracks are not known, "no sparse points to tell from"; empty where they are.
  std::string unknown_because;
  bool has_poses = true;
  bool has_points = false;   // enough of them
  std::optional<Ball> hull;  // about what alpha leaves; nullopt: none, or it may reach far
  PointShares shares;        // where there are points and no alpha
  TrackColors colors;        // these two where colours are known
  PhotographFit fit;
  // Exposure of each photograph against their mean, log2 of light; empty: unknown.
  std::vector<double> stops;
  std::string stops_source;  // "in the same points", "by their EXIF"
  std::string warning;       // about the input, one line; or empty

  bool HasAlpha() const { return facts.transparent > 0; }
  bool HasTracks() const { return unknown_because.empty(); }
};

// Looks at the photographs and at the sparse points, where structure from motion has left some: the
// colours of each point over the photographs that see it.
//   read  called with the number of photographs read
// Throws InputError naming a mask that is broken.
CaptureEvidence CollectEvidence(const PosedImages& posed, bool may_learn_background,
                                const std::function<void(int)>& read = {});

// What photographs alone show, before their poses are known: alpha, linear radiance, masks, EXIF.
//   photographs  without poses and cameras
CaptureEvidence CollectEvidenceOfPhotographs(const PosedImages& photographs);

}  // namespace nerf
