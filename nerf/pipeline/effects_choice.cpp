#include "nerf/pipeline/effects_choice.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "nerf/base/atomic_file.h"
#include "nerf/base/progress.h"
#include "nerf/base/stopwatch.h"
#include "nerf/pipeline/effect_trial.h"
#include "nerf/pipeline/effects_trials.h"

namespace nerf {
namespace {

// What photographs and files are needs no choice.
bool IsChosen(const Verdict& verdict) {
  return verdict.effect != "alpha" && verdict.effect != "hdr";
}

}  // namespace

EffectsChoice::EffectsChoice(const PosedImages& posed, const Config& asked,
                             std::set<std::string> named)
    : named_(std::move(named)) {
  const Stopwatch watch;
  ProgressLine progress("looking", static_cast<std::int64_t>(posed.images.size()));
  const bool learned = !named_.contains("background") || asked.effects.background;
  inspection_ = Inspect(
      posed, [&](int read) { progress.Update(read); }, learned);
  progress.Finish();
  if (!inspection_.warning.empty()) spdlog::warn("{}", inspection_.warning);
  for (const Verdict& verdict : inspection_.verdicts) {
    if (!IsChosen(verdict) || named_.contains(verdict.effect) || !verdict.IsConclusive()) continue;
    assignments_.push_back(verdict.assignment);
  }
  seconds_ = watch.Seconds();
}

std::vector<double> EffectsChoice::StopsOfTrained(const PosedImages& posed,
                                                  const Dataset& data) const {
  std::map<std::string, double> stops_of;
  for (std::size_t i = 0; i < inspection_.stops.size(); ++i) {
    stops_of[posed.images[i].name] = inspection_.stops[i];
  }
  std::vector<double> stops;
  for (const View& view : data.train) {
    if (const auto found = stops_of.find(view.name); found != stops_of.end()) {
      stops.push_back(found->second);
    }
  }
  return stops.size() == data.train.size() ? stops : std::vector<double>();
}

bool EffectsChoice::IsOpen(const std::string& effect) const {
  return std::ranges::any_of(inspection_.verdicts, [&](const Verdict& verdict) {
    return verdict.effect == effect && nerf::IsOpen(verdict, named_);
  });
}

void EffectsChoice::HeedAlpha() {
  const auto find = [&](const char* effect) {
    return std::ranges::find(inspection_.verdicts, effect, &Verdict::effect);
  };
  const auto replace = [&](Verdict& verdict, bool on, const char* why) {
    if (named_.contains(verdict.effect)) return;
    verdict = Fact(verdict.effect, on, 0, why);
    assignments_.push_back(verdict.assignment);
    fmt::print("{}", RowOf(verdict));
  };
  const auto background = find("background"), unbounded = find("unbounded");
  const auto end = inspection_.verdicts.end();
  if (background == end || !background->decided || (!background->on && background->IsConclusive()))
    return;
  if (background->on && unbounded != end && !unbounded->on) {
    replace(*unbounded, true, "no background is learned that would hold what is far");
  }
  replace(*background, false, "some photograph has alpha, and shows none");
}

void EffectsChoice::Try(const Config& config, const SceneFacts& scene, double seconds_left,
                        Dataset& data) {
  const EffectTrials trials =
      TryWhatIsOpen(config, scene, named_, seconds_left, data, inspection_.verdicts);
  assignments_.insert(assignments_.end(), trials.assignments.begin(), trials.assignments.end());
  trial_seconds_ = trials.seconds;
  std::vector<std::string> open;
  for (const Verdict& v : inspection_.verdicts) {
    if (IsChosen(v) && nerf::IsOpen(v, named_)) open.push_back(v.effect);
  }
  if (!open.empty()) {
    fmt::print("not sure, and so as configured: {}\n", fmt::join(open, ", "));
    std::fflush(stdout);
  }
}

void EffectsChoice::Print() const {
  const std::vector<Verdict>& verdicts = inspection_.verdicts;
  if (inspection_.stops.empty()) {
    // Most is undecided, and the table would be long for what it tells.
    std::vector<std::string> facts;
    for (const Verdict& v : verdicts) {
      if (v.on && v.effect != "unbounded") facts.push_back(v.effect);
      if (v.decided && !v.on && v.effect == "unbounded") facts.push_back("not " + v.effect);
    }
    fmt::print("effects: no sparse points to tell from, so as configured{}{}\n",
               facts.empty() ? "" : "; and ", fmt::join(facts, ", "));
  } else {
    fmt::print("what the capture calls for ({:.1f} s):\n{}", seconds_, TableOf(verdicts));
  }
  if (!named_.empty()) {
    fmt::print("as asked for, whatever the capture calls for: {}\n", fmt::join(named_, ", "));
  }
  std::fflush(stdout);
}

void EffectsChoice::Write(const Config& config, const std::filesystem::path& run) const {
  nlohmann::json verdicts = nlohmann::json::array(), simulated = nlohmann::json::array();
  for (const std::string& effect : EffectNames()) {
    if (Simulates(config, effect)) simulated.push_back(effect);
  }
  for (const Verdict& v : inspection_.verdicts) {
    verdicts.push_back({{"effect", v.effect},
                        {"evidence", v.evidence},
                        {"decided", v.decided},
                        {"on", v.on},
                        {"confidence", v.Confidence()},
                        {"asked_for", named_.contains(v.effect)}});
  }
  const nlohmann::json root = {{"verdicts", verdicts}, {"simulated", simulated},
                               {"asked_for", named_},  {"assignments", assignments_},
                               {"seconds", seconds_},  {"trial_seconds", trial_seconds_}};
  WriteFileAtomically(run / "effects.json", root.dump(2) + "\n");
}

}  // namespace nerf
