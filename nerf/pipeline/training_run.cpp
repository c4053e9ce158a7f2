#include "nerf/pipeline/training_run.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/interrupt.h"
#include "nerf/base/progress.h"
#include "nerf/config/config.h"
#include "nerf/effects/depth.h"
#include "nerf/model/checkpoint.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/budget_plan.h"
#include "nerf/pipeline/effects_choice.h"
#include "nerf/pipeline/effects_request.h"
#include "nerf/pipeline/pose_refinement_report.h"
#include "nerf/pipeline/training_input.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/scene_normalization.h"
#include "nerf/scene/splits.h"
#include "nerf/train/trainer.h"
#include "sfm/pose_input.h"
#include "sfm/transforms_json.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

fs::path RunFolder(const TrainArguments& arguments) {
  if (!arguments.output.empty()) return arguments.output;
  if (arguments.input.empty()) {
    throw InputError("nerf train: name an INPUT, or with --resume the run with -o RUN");
  }
  fs::path name = fs::absolute(arguments.input).lexically_normal();
  if (!name.has_filename()) name = name.parent_path();  // a slash at the end
  // photos/fox/transforms.json is the fox's.
  if (name.extension() == ".json") name = name.parent_path();
  return fs::path("runs") / name.filename();
}

// A folder is a run's own once it holds a run's config.json. Somebody else's transforms.json there,
// maybe the very input, is not to be written over.
void RequireOwnFolder(const fs::path& run) {
  if (fs::exists(CheckpointPath(run))) {
    throw InputError(
        "{}: holds a run already; add --resume to go on with it, or choose another folder with -o",
        run.string());
  }
  for (const fs::path& file : {PosesPath(run), MetricsPath(run)}) {
    if (!fs::exists(file) || fs::exists(ConfigPath(run))) continue;
    throw InputError("{}: is there already, and not from nerf train; choose another -o",
                     file.string());
  }
}

void Report(const TrainSummary& summary, const TrainOptions& options, const fs::path& run) {
  const std::string psnr = summary.validation_psnr > 0
                               ? fmt::format(", validation {:.2f} dB", summary.validation_psnr)
                               : "";
  if (summary.finished) {
    fmt::print("trained {} steps in {:.1f} s{}\n", summary.step, summary.training_seconds, psnr);
    if (options.target_psnr > 0) {
      fmt::print("{} dB {}\n", options.target_psnr,
                 summary.reached_target ? "are reached" : "were not reached");
    }
    const auto last = summary.curve.SecondsOfLast(0.5), next = summary.curve.SecondsForNext(0.5);
    if (last && next) {
      fmt::print("the last 0.5 dB cost {}; 0.5 dB more would take about {} more\n",
                 FormatSeconds(*last), FormatSeconds(*next));
    }
    fmt::print("{}\nnext: nerf eval {}\n", run.string(), run.string());
  } else {
    fmt::print("stopped at step {}, saved{}\ngo on with: nerf train --resume -o {}\n", summary.step,
               psnr, run.string());
  }
}

// What --set and the flags beside it say.
std::vector<std::string> AssignmentsOf(const TrainArguments& arguments) {
  std::vector<std::string> assignments = arguments.assignments;
  if (arguments.downscale) {
    assignments.push_back(fmt::format("data.downscale={}", *arguments.downscale));
  }
  if (arguments.time_budget) {
    assignments.push_back(fmt::format("train.time_budget={}", *arguments.time_budget));
  }
  if (arguments.target_psnr) {
    assignments.push_back(fmt::format("train.target_psnr={}", *arguments.target_psnr));
  }
  return assignments;
}

void WriteConfig(const Config& config, const fs::path& run) {
  WriteFileAtomically(ConfigPath(run), JsonFromConfig(config).dump(2) + "\n");
}

// A target is measured on photographs that training does not see.
void RequireValidation(const PosedImages& posed, const Config& config) {
  const auto validates = [](const auto& image) { return image.split == Split::kValidation; };
  if (config.train.target_psnr == 0 || std::ranges::any_of(posed.images, validates)) return;
  throw InputError(
      "train.target_psnr is measured on validation photographs, and there are none: set "
      "data.validation_images to 1 or more, and take 16 photographs at least");
}

// Seconds of the time budget that are gone. Finding poses cannot be bounded: training gets at least
// half of what was asked for.
double SpentOf(const Config& config, const Stopwatch& watch) {
  const double budget = config.train.time_budget, spent = watch.Seconds();
  if (budget == 0 || spent <= budget / 2) return spent;
  spdlog::warn("{} of the time budget were gone before training; it still gets {}",
               FormatSeconds(spent), FormatSeconds(budget / 2));
  return budget / 2;
}

}  // namespace

void StartRun(const TrainArguments& arguments, int threads, const Stopwatch& watch) {
  const fs::path run = RunFolder(arguments);
  if (arguments.input.empty()) throw InputError("nerf train: name an INPUT");
  std::vector<std::string> assignments = AssignmentsOf(arguments);
  const EffectsRequest effects = ParseEffects(arguments.effects);
  assignments.insert(assignments.end(), effects.assignments.begin(), effects.assignments.end());
  EffectsChoice choice;
  // With what is decided of effects so far.
  const auto configured = [&](const std::string& preset) {
    std::vector<std::string> all = assignments;
    all.insert(all.end(), choice.Assignments().begin(), choice.Assignments().end());
    return LoadConfig(preset, all);
  };
  Config config = configured(arguments.preset);
  RequireOwnFolder(run);
  sfm::FindInput(arguments.input);  // a wrong input must not leave an empty run behind
  PosedImages found = FindPoses(arguments.input, run, threads);
  WarnOfMissing(found);
  AssignSplits(found, config.data);
  RequireValidation(found, config);
  SceneNormalization normalized_from_world = NormalizeScene(found);
  if (effects.inspect) {
    choice = EffectsChoice(found, config, NamedEffects(arguments.preset, assignments));
    normalized_from_world = choice.GetInspection().normalized_from_world;
    config = configured(arguments.preset);
  }
  MakeOutputFolder(run);
  KeepSparsePoints(found, config, run);
  if (effects.inspect) choice.Print();
  // First, for it marks the folder as a run's own.
  WriteConfig(config, run);
  sfm::WriteTransformsJson(found, PosesPath(run));
  // Read back, so that a run which resumes starts from the same numbers to the last bit.
  const PosedImages posed = sfm::ReadTransformsJson(PosesPath(run));

  PrintDataPlan(posed, config.data, threads);
  Dataset data = LoadOrWarn(posed, config, normalized_from_world, run);
  SceneFacts scene = FactsOf(data, normalized_from_world);
  if (effects.inspect) {
    scene.exposure_stops = choice.StopsOfTrained(found, data);
    if (scene.has_alpha) choice.HeedAlpha();
    config = configured(arguments.preset);
    const bool tries_depth = choice.IsOpen("depth");
    if (tries_depth) AddSeenPoints(found, normalized_from_world, data);
    choice.Try(config, scene, config.train.time_budget - watch.Seconds(), data);
    config = configured(arguments.preset);
    WriteConfig(config, run);
    choice.Write(config, run);
    if (tries_depth && config.effects.depth) {
      // As a run that resumes reads them.
      KeepSparsePoints(found, config, run);
      AddKeptPoints(posed, normalized_from_world, run, data);
    }
  }
  const double spent = SpentOf(config, watch);
  auto trainer = std::make_unique<Trainer>(config, scene, data, run, spent);
  if (config.train.time_budget > 0 && !arguments.preset_given) {
    const double left = config.train.time_budget - spent;
    const BudgetPlan plan = PlanBudget(*trainer, left);
    fmt::print("time budget {}: preset {}, about {:.0f} steps\n",
               FormatDuration(config.train.time_budget), plan.preset, plan.steps);
    std::fflush(stdout);
    if (plan.preset != arguments.preset) {
      config = configured(plan.preset);
      WriteConfig(config, run);
      trainer = std::make_unique<Trainer>(config, scene, data, run, SpentOf(config, watch));
    }
  }
  const TrainSummary summary = trainer->Run(StopOnInterrupt());
  ReportRefinedPoses(trainer->GetModel(), posed, run);
  Report(summary, config.train, run);
}

void ResumeRun(const TrainArguments& arguments, int threads, const Stopwatch& watch) {
  const fs::path run = RunFolder(arguments);
  if (!AssignmentsOf(arguments).empty() || arguments.preset_given || arguments.effects != "auto") {
    throw InputError(
        "--resume goes on with the run's own configuration; leave --config, --set, --effects, "
        "--downscale, --time-budget and --target-psnr away");
  }
  const Checkpoint checkpoint = ReadRunCheckpoint(run);
  const Model model = ModelFromCheckpoint(checkpoint);
  if (const int before = checkpoint.meta.value("threads", threads); before != threads) {
    spdlog::warn("the run was on {} threads and goes on with {}; sums will round differently",
                 before, threads);
  }
  const PosedImages posed = sfm::ReadTransformsJson(PosesPath(run));
  WarnOfMissing(posed);
  PrintDataPlan(posed, model.config.data, threads);
  const Dataset data = LoadOrWarn(posed, model.config, model.scene.normalized_from_world, run);
  Trainer trainer(checkpoint, data, run, watch.Seconds());
  const TrainSummary summary = trainer.Run(StopOnInterrupt());
  ReportRefinedPoses(trainer.GetModel(), posed, run);
  Report(summary, model.config.train, run);
}

}  // namespace nerf
