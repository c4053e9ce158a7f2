#include "nerf/pipeline/light_effects.h"

#include <algorithm>
#include <cmath>

namespace nerf {
namespace {

constexpr int kTrialSteps = 60;
constexpr int kTrialPoints = 512;  // of a step

bool IsOn(LightEffectChoice choice, bool evidence) {
  if (choice == LightEffectChoice::kAuto) return evidence;
  return choice == LightEffectChoice::kOn;
}

// dB, of the pixels of the last third of the steps: hardly any was drawn before.
double PsnrOfTrial(const LitSurface& lit, const MaterialOptions& options,
                   const Eigen::AlignedBox3d& box, int resolution, bool is_matt,
                   std::uint64_t seed) {
  MaterialOptions shorter = options;
  shorter.points = std::min(options.points, kTrialPoints);
  MaterialFit fit(lit, std::make_shared<MaterialField>(box, resolution, is_matt, seed), shorter,
                  seed);
  double sum = 0;
  for (int step = 0; step < kTrialSteps; ++step) {
    const double error = fit.Step(static_cast<double>(step) / kTrialSteps);
    if (3 * step >= 2 * kTrialSteps) sum += error;
  }
  return -10 * std::log10(3 * sum / kTrialSteps);
}

}  // namespace

LightEffects DecideLightEffects(const MaterialOptions& options, const ExtractedSurface& surface,
                                const MeshRays& rays, const Eigen::AlignedBox3d& box,
                                int resolution, std::uint64_t seed, bool with_trial,
                                LitSurface& lit) {
  LightEffects effects;
  const bool asks_rays =
      options.shadows == LightEffectChoice::kAuto || options.bounces == LightEffectChoice::kAuto;
  if (asks_rays) {
    effects.blocked =
        BlockedShare(surface.mesh, rays, static_cast<float>(kShadowOffset * surface.distance.cell));
  }
  const double blocked = effects.blocked.value_or(0);
  effects.shadows = IsOn(options.shadows, blocked >= kLeastBlocked);
  effects.bounces = effects.shadows && IsOn(options.bounces, blocked >= kLeastBounced);
  if (effects.shadows) {
    AddShadows(surface, rays, effects.bounces, lit);
  } else {
    RemoveShadows(lit);
  }
  if (options.specular == LightEffectChoice::kAuto && with_trial) {
    effects.specular_db = PsnrOfTrial(lit, options, box, resolution, false, seed) -
                          PsnrOfTrial(lit, options, box, resolution, true, seed);
  }
  effects.specular = IsOn(options.specular, effects.specular_db.value_or(0) >= kLeastSpecular);
  return effects;
}

}  // namespace nerf
