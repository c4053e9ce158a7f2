#pragma once

#include <optional>

#include "nerf/pipeline/lit_surface.h"

namespace nerf {

// Which effects of light are simulated, and the evidence.
struct LightEffects {
  bool shadows = true, bounces = true, specular = true;
  std::optional<double> blocked;      // share of the light directions, by cosine; absent: not asked
  std::optional<double> specular_db;  // by which a coat explains the photographs better in a trial
};

// Shadows are worth their cost from this share of blocked directions on, and light that surfaces
// send each other, which is at most that share of all, from this one on.
inline constexpr double kLeastBlocked = 0.02, kLeastBounced = 0.04;
// And a coat from this difference in a trial, dB.
inline constexpr double kLeastSpecular = 0.1;

// Decides what options leave open, first shadows and bounces by rays from some vertices, then
// specular by two short fits. Adds the shadows to `lit`.
//   box         of the material field
//   resolution  of the material field
//   with_trial  whether there is time for one; else no coat is simulated
LightEffects DecideLightEffects(const MaterialOptions& options, const ExtractedSurface& surface,
                                const MeshRays& rays, const Eigen::AlignedBox3d& box,
                                int resolution, std::uint64_t seed, bool with_trial,
                                LitSurface& lit);

}  // namespace nerf
