#include "nerf/pipeline/effect_decisions.h"

#include <algorithm>
#include <utility>

#include "nerf/pipeline/effect_trials.h"

namespace nerf {
namespace {

// Whether a verdict is a decision; alpha and HDR are properties of the photographs.
bool IsDecision(const Verdict& verdict) {
  return verdict.effect != kAlpha && verdict.effect != kHdr;
}

}  // namespace

EffectDecisions::EffectDecisions(const Inspection& inspection, std::set<std::string> requested)
    : verdicts_(inspection.verdicts), requested_(std::move(requested)) {
  for (const Verdict& verdict : verdicts_) {
    if (!IsDecision(verdict) || requested_.contains(verdict.effect)) continue;
    if (!verdict.IsConclusive()) continue;
    assignments_.push_back(verdict.assignment);
  }
}

bool EffectDecisions::ShouldTry(const EffectDescriptor& effect) const {
  return std::ranges::any_of(verdicts_, [&](const Verdict& verdict) {
    return verdict.effect == effect.name && nerf::ShouldTry(verdict, requested_);
  });
}

void EffectDecisions::DisableBackgroundForAlpha(const PipelineListener& listener) {
  const auto find = [&](const EffectDescriptor& effect) {
    return std::ranges::find(verdicts_, effect.name, &Verdict::effect);
  };
  const auto replace = [&](Verdict& verdict, bool on, const char* evidence) {
    if (requested_.contains(verdict.effect)) return;
    verdict = Fact(verdict.effect, on, 0, evidence);
    assignments_.push_back(verdict.assignment);
    listener(VerdictReached{verdict});
  };
  const auto background = find(kBackgroundEffect), unbounded = find(kUnboundedEffect);
  const auto end = verdicts_.end();
  if (background == end || !background->decided ||
      (!background->on && background->IsConclusive())) {
    return;
  }
  if (background->on && unbounded != end && !unbounded->on) {
    replace(*unbounded, true, "distant points need contracted space without a learned background");
  }
  replace(*background, false, "some photographs have alpha and therefore no background");
}

void EffectDecisions::RunTrials(const Config& config, const SceneFacts& scene, double seconds_left,
                                Dataset& data, const PipelineListener& listener) {
  const EffectTrials trials =
      RunEffectTrials(config, scene, requested_, seconds_left, data, verdicts_, listener);
  assignments_.insert(assignments_.end(), trials.assignments.begin(), trials.assignments.end());
  trial_seconds_ = trials.seconds;
  EffectsUndecided undecided;
  for (const Verdict& v : verdicts_) {
    if (IsDecision(v) && nerf::ShouldTry(v, requested_)) undecided.effects.push_back(v.effect);
  }
  if (!undecided.effects.empty()) listener(undecided);
}

nlohmann::json EffectDecisions::Report(const Config& config, double inspection_seconds) const {
  nlohmann::json verdicts = nlohmann::json::array(), simulated = nlohmann::json::array();
  for (const EffectDescriptor* effect : AllEffects()) {
    if (Simulates(config.effects, *effect)) simulated.push_back(effect->name);
  }
  for (const Verdict& v : verdicts_) {
    verdicts.push_back({{"effect", v.effect},
                        {"evidence", v.evidence},
                        {"decided", v.decided},
                        {"on", v.on},
                        {"confidence", v.Confidence()},
                        {"asked_for", requested_.contains(v.effect)}});
  }
  return {{"verdicts", verdicts},          {"simulated", simulated},
          {"asked_for", requested_},       {"assignments", assignments_},
          {"seconds", inspection_seconds}, {"trial_seconds", trial_seconds_}};
}

}  // namespace nerf
