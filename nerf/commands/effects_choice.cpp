#include "nerf/commands/effects_choice.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "nerf/config.h"
#include "nerf/stopwatch.h"
#include "nerf/train/effect_trial.h"
#include "sfm/atomic_file.h"
#include "sfm/input_error.h"
#include "sfm/progress.h"

namespace nerf {
namespace {

// What automatic choices act on. The evidence for the others is shown, and they are simulated when
// asked for: a robust loss may lose where directions show (README, "Effects"), and to leave
// directions away has not been measured on real captures that call for it.
const std::set<std::string> kAutomatic = {"exposure", "masks",     "depth",     "near",
                                          "poses",    "footprint", "unbounded", "background"};

// Trials tell what shows early; that colour depends on the direction shows late.
const std::set<std::string> kTried = {"exposure"};
constexpr int kTrialSteps = 200;
constexpr std::int64_t kTrialSamples = 16384;  // a step
constexpr double kWorthIt = 0.2;               // dB, more than the noise of a trial
constexpr double kSureEnough = 0.5;
constexpr double kShortestBudget = 120;  // seconds; of a shorter one trials would take too much

std::string Join(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

EffectsRequest ParseEffects(const std::string& text) {
  if (text == "auto") return {};
  if (text == "config") return {false, {}};
  EffectsRequest request;
  const std::vector<std::string> known = EffectNames();
  std::istringstream list(text);
  for (std::string word; std::getline(list, word, ',');) {
    const bool on = word.starts_with('+'), off = word.starts_with('-');
    const std::string name = word.substr(on || off ? 1 : 0);
    if ((!on && !off) || std::ranges::find(known, name) == known.end()) {
      throw sfm::InputError(
          "--effects {}: '{}' is none; use auto, config, or a list like +exposure,-view of {}",
          text, word, Join(known));
    }
    request.assignments.push_back(EffectAssignment(name, on ? "{}" : "null"));
  }
  return request;
}

EffectsChoice ChooseEffects(const sfm::PosedImages& posed, const std::set<std::string>& named) {
  const Stopwatch watch;
  EffectsChoice choice;
  {
    sfm::ProgressLine progress("looking", static_cast<std::int64_t>(posed.images.size()));
    choice.inspection = Inspect(posed, [&](int read) { progress.Update(read); });
    progress.Finish();
    const std::string& warning = choice.inspection.warning;
    if (!warning.empty()) spdlog::warn("{}", warning);
  }
  for (const Verdict& verdict : choice.inspection.verdicts) {
    const bool acts = kAutomatic.contains(verdict.effect) && !named.contains(verdict.effect);
    if (!acts || verdict.Sure() < kSureEnough) continue;
    choice.assignments.push_back(verdict.assignment);
  }
  choice.seconds = watch.Seconds();
  return choice;
}

void PrintEffects(const EffectsChoice& choice, const std::set<std::string>& named) {
  const std::vector<Verdict>& verdicts = choice.inspection.verdicts;
  if (choice.inspection.stops.empty()) {
    // Most is undecided, and the table would be long for what it tells.
    std::vector<std::string> facts;
    for (const Verdict& v : verdicts) {
      if (v.on && v.effect != "unbounded") facts.push_back(v.effect);
      if (v.decided && !v.on && v.effect == "unbounded") facts.push_back("not " + v.effect);
    }
    fmt::print("effects: no sparse points to tell from, so as configured{}{}\n",
               facts.empty() ? "" : "; and ", Join(facts));
  } else {
    fmt::print("what the capture calls for ({:.1f} s):\n{}", choice.seconds, TableOf(verdicts));
  }
  if (!named.empty()) {
    fmt::print("as asked for, whatever the capture calls for: {}\n",
               Join({named.begin(), named.end()}));
  }
  std::fflush(stdout);
}

void TryWhatIsOpen(const Config& config, const SceneFacts& scene, const Dataset& data,
                   const std::set<std::string>& named, EffectsChoice& choice) {
  const double budget = config.train.time_budget;
  if (data.validation.empty() || (budget > 0 && budget < kShortestBudget)) return;
  const Stopwatch watch;
  Config trial = config;
  trial.train.samples_per_batch = kTrialSamples;
  std::optional<TrialResult> without;
  for (Verdict& verdict : choice.inspection.verdicts) {
    const bool open = verdict.Sure() < kSureEnough;
    if (!open || !kTried.contains(verdict.effect) || named.contains(verdict.effect)) continue;
    const auto psnr = [&](const char* setting) {
      return TryConfig(WithEffect(trial, verdict.effect, setting), scene, data, kTrialSteps);
    };
    if (!without || Simulates(config, verdict.effect)) without = psnr("null");
    const TrialResult with = psnr("{}");
    verdict.figure = with.psnr - without->psnr;
    verdict.threshold = kWorthIt;
    verdict.decided = true;
    verdict.on = verdict.figure >= kWorthIt;
    verdict.assignment = EffectAssignment(verdict.effect, verdict.on ? "{}" : "null");
    verdict.evidence = fmt::format("{}; tried: {:.2f} dB with it, {:.2f} dB without",
                                   verdict.evidence, with.psnr, without->psnr);
    choice.assignments.push_back(verdict.assignment);
    fmt::print("{:<11} {:<9} {:>5}  {}\n", verdict.effect, verdict.on ? "on" : "off", "",
               verdict.evidence);
  }
  choice.trial_seconds = watch.Seconds();
  if (without) fmt::print("tried for {:.1f} s\n", choice.trial_seconds);
  std::fflush(stdout);
}

void WriteEffects(const EffectsChoice& choice, const std::set<std::string>& named,
                  const std::filesystem::path& run) {
  nlohmann::json verdicts = nlohmann::json::array();
  for (const Verdict& v : choice.inspection.verdicts) {
    verdicts.push_back({{"effect", v.effect},
                        {"evidence", v.evidence},
                        {"decided", v.decided},
                        {"on", v.on},
                        {"sure", v.Sure()},
                        {"asked_for", named.contains(v.effect)}});
  }
  const nlohmann::json root = {{"verdicts", verdicts},
                               {"asked_for", named},
                               {"assignments", choice.assignments},
                               {"seconds", choice.seconds},
                               {"trial_seconds", choice.trial_seconds}};
  sfm::WriteFileAtomically(run / "effects.json", root.dump(2) + "\n");
}

}  // namespace nerf
