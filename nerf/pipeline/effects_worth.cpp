#include "nerf/pipeline/effects_worth.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/progress.h"
#include "nerf/config/config.h"
#include "nerf/pipeline/effect_trial.h"
#include "nerf/pipeline/held_out.h"
#include "nerf/pipeline/training_input.h"
#include "nerf/scene/dataset.h"
#include "sfm/transforms_json.h"

namespace nerf {
namespace {

struct Worth {
  std::string effect;
  TrialResult with, without;
  bool on_halves = false;  // of photographs, and not on those that are held out
};

// The photographs, with those held out to be measured on.
PosedImages MeasuredOnHeldOut(const std::filesystem::path& poses) {
  PosedImages posed = sfm::ReadTransformsJson(poses);
  bool any = false;
  for (PosedImage& image : posed.images) {
    if (image.split == Split::kValidation) image.split = Split::kTrain;
    if (image.split == Split::kTest) image.split = Split::kValidation;
    any = any || image.split == Split::kValidation;
  }
  if (!any) {
    throw InputError("{}: no photograph is held out to measure effects on; take 8 at least",
                     poses.string());
  }
  return posed;
}

nlohmann::json JsonFrom(const std::vector<Worth>& all, int steps) {
  nlohmann::json effects = nlohmann::json::array();
  for (const Worth& w : all) {
    effects.push_back({{"effect", w.effect},
                       {"psnr_with", w.with.psnr},
                       {"psnr_without", w.without.psnr},
                       {"on_halves", w.on_halves},
                       {"seconds_a_step_with", w.with.seconds_a_step},
                       {"seconds_a_step_without", w.without.seconds_a_step},
                       {"megabytes", w.with.megabytes - w.without.megabytes}});
  }
  return {{"steps", steps}, {"effects", effects}};
}

void PrintTable(const std::vector<Worth>& all, int steps) {
  if (all.empty()) fmt::print("the run simulates no effect that could be left away\n");
  if (all.empty()) return;
  fmt::print("{:<11} {:>8} {:>9} {:>8} {:>16} {:>9}\n", "effect", "with dB", "without", "worth dB",
             "time of a step", "memory MB");
  for (const Worth& w : all) {
    fmt::print("{:<11} {:>8.2f} {:>9.2f} {:>+8.2f} {:>+14.1f} % {:>+9.2f}\n", w.effect, w.with.psnr,
               w.without.psnr, w.with.psnr - w.without.psnr,
               100 * (w.with.seconds_a_step / w.without.seconds_a_step - 1),
               w.with.megabytes - w.without.megabytes);
  }
  fmt::print(
      "after {} steps, on the held-out photographs, each at its own exposure; more training may "
      "change it\n",
      steps);
  for (const Worth& w : all) {
    if (!w.on_halves) continue;
    fmt::print("{}: on the right halves of photographs whose left halves are learned from\n",
               w.effect);
  }
}

}  // namespace

void MeasureEffects(const OpenedRun& run, int steps, bool json,
                    const std::filesystem::path& output) {
  const Config& config = run.model.config;
  const PosedImages posed = MeasuredOnHeldOut(run.posed.source);
  Dataset data = LoadOrWarn(posed, config, run.model.scene.normalized_from_world,
                            run.posed.source.parent_path());
  const auto try_with = [&](const Config& tried, const Dataset& photographs) {
    return TryConfig(tried, FactsOf(photographs, run.model.scene.normalized_from_world),
                     photographs, steps);
  };
  // Without masks what they hide is learned from; measured are the same pixels. Of masks that mean
  // empty there is nothing to measure: what they hide is not of the scene.
  const auto try_without = [&](const std::string& effect) {
    const Config without = WithEffect(config, effect, "null");
    if (effect != "masks") return try_with(without, data);
    Dataset unmasked = LoadOrWarn(posed, without, run.model.scene.normalized_from_world,
                                  run.posed.source.parent_path());
    unmasked.validation = data.validation;
    return try_with(without, unmasked);
  };
  std::vector<std::string> effects;
  for (const std::string& effect : EffectNames()) {
    const bool empty =
        effect == "masks" && config.effects.masks && config.effects.masks->meaning == "empty";
    if (Simulates(config, effect) && !empty) effects.push_back(effect);
  }
  ProgressLine progress("measuring", 2 * static_cast<std::int64_t>(effects.size()));
  std::vector<Worth> all;
  for (const std::string& effect : effects) {
    // Poses of photographs that are held out are refined by nobody: halves of others are measured.
    std::optional<HeldOutHalves> halves;
    if (effect == "poses") halves.emplace(data);
    if (halves && halves->Count() == 0) halves.reset();
    // With and without in turn, so that both see the same neighbours on the machine.
    const TrialResult with = try_with(config, data);
    progress.Update(2 * static_cast<std::int64_t>(all.size()) + 1, effect);
    all.push_back({effect, with, try_without(effect), halves.has_value()});
    progress.Update(2 * static_cast<std::int64_t>(all.size()), effect);
  }
  progress.Finish();
  const nlohmann::json result = JsonFrom(all, steps);
  WriteFileAtomically(output / "effects_worth.json", result.dump(2) + "\n");
  if (json) {
    fmt::print("{}\n", result.dump(2));
  } else {
    PrintTable(all, steps);
  }
}

}  // namespace nerf
