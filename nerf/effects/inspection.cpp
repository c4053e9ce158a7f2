#include "nerf/effects/inspection.h"

#include <spdlog/fmt/fmt.h>

#include "nerf/effects/effects.h"
#include "nerf/effects/near_plane.h"
#include "nerf/inspect/evidence.h"
#include "nerf/inspect/visual_hull.h"

namespace nerf {
namespace {

void AddFacts(const PhotographFacts& facts, std::vector<Verdict>& verdicts) {
  verdicts.push_back(
      Fact(kAlpha, facts.transparent > 0, facts.transparent,
           facts.transparent > 0
               ? fmt::format("{:.0f} % of the pixels are transparent", 100 * facts.transparent)
               : "no pixel is transparent"));
  verdicts.push_back(
      Fact(kHdr, facts.linear, facts.above_white,
           facts.linear ? fmt::format("linear radiance, {:.1f} % of the pixels brighter than 1",
                                      100 * facts.above_white)
                        : "display-referred files"));
}

Inspection InspectionOf(const CaptureEvidence& evidence) {
  Inspection inspection;
  AddFacts(evidence.facts, inspection.verdicts);
  for (const EffectDescriptor* effect : AllEffects()) {
    inspection.verdicts.push_back(effect->judge(evidence));
  }
  inspection.stops = evidence.stops;
  inspection.warning = evidence.warning;
  return inspection;
}

// The frame in which the ball that bounds the scene is the unit ball.
SceneNormalization BoundedFrame(const CaptureEvidence& evidence) {
  const Verdict unbounded = kUnboundedEffect.judge(evidence);
  if (unbounded.on) return evidence.frame;
  return NormalizedTo(evidence.hull ? *evidence.hull : evidence.shares.near, evidence.frame);
}

}  // namespace

Inspection InspectPhotographs(const PosedImages& photographs) {
  return InspectionOf(CollectEvidenceOfPhotographs(photographs));
}

Inspection Inspect(const PosedImages& posed, const std::function<void(int)>& read,
                   bool may_learn_background) {
  const CaptureEvidence evidence = CollectEvidence(posed, may_learn_background, read);
  Inspection inspection = InspectionOf(evidence);
  inspection.normalized_from_world = BoundedFrame(evidence);
  if (evidence.HasTracks()) {
    inspection.residuals = ResidualsByAngle(posed, evidence.colors, evidence.fit);
    inspection.verdicts.push_back(JudgeNearPlane(posed, inspection.normalized_from_world));
  }
  return inspection;
}

}  // namespace nerf
