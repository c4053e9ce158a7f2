#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "nerf/commands/commands.h"
#include "nerf/commands/effects_choice.h"
#include "nerf/commands/interrupt.h"
#include "nerf/commands/refined_poses.h"
#include "nerf/commands/threads.h"
#include "nerf/commands/training_input.h"
#include "nerf/config.h"
#include "nerf/data/dataset.h"
#include "nerf/stopwatch.h"
#include "nerf/train/budget_plan.h"
#include "nerf/train/checkpoint.h"
#include "nerf/train/run_folder.h"
#include "nerf/train/trainer.h"
#include "sfm/atomic_file.h"
#include "sfm/input_error.h"
#include "sfm/pose_input.h"
#include "sfm/progress.h"
#include "sfm/scene_normalization.h"
#include "sfm/transforms_json.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

struct TrainArguments {
  std::string input;
  std::string output;
  std::string preset = "balanced";
  bool preset_given = false;
  std::vector<std::string> assignments;
  std::string effects = "auto";
  std::optional<int> downscale;
  std::optional<double> time_budget;  // seconds
  std::optional<double> target_psnr;  // dB
  int threads = 0;
  bool resume = false;
};

fs::path RunFolder(const TrainArguments& arguments) {
  if (!arguments.output.empty()) return arguments.output;
  if (arguments.input.empty()) {
    throw sfm::InputError("nerf train: name an INPUT, or with --resume the run with -o RUN");
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
    throw sfm::InputError(
        "{}: holds a run already; add --resume to go on with it, or choose another folder with -o",
        run.string());
  }
  for (const fs::path& file : {PosesPath(run), MetricsPath(run)}) {
    if (!fs::exists(file) || fs::exists(ConfigPath(run))) continue;
    throw sfm::InputError("{}: is there already, and not from nerf train; choose another -o",
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
                 sfm::FormatSeconds(*last), sfm::FormatSeconds(*next));
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

// Another preset for the same scene.
Config WithEffectsOf(const Config& decided, Config preset) {
  preset.effects = decided.effects;
  preset.march.near_distance = decided.march.near_distance;
  return preset;
}

void WriteConfig(const Config& config, const fs::path& run) {
  sfm::WriteFileAtomically(ConfigPath(run), JsonFromConfig(config).dump(2) + "\n");
}

// A target is measured on photographs that training does not see.
void RequireValidation(const sfm::PosedImages& posed, const Config& config) {
  const auto validates = [](const auto& image) { return image.split == sfm::Split::kValidation; };
  if (config.train.target_psnr == 0 || std::ranges::any_of(posed.images, validates)) return;
  throw sfm::InputError(
      "train.target_psnr is measured on validation photographs, and there are none: set "
      "data.validation_images to 1 or more, and take 16 photographs at least");
}

// Seconds of the time budget that are gone. Finding poses cannot be bounded: training gets at least
// half of what was asked for.
double SpentOf(const Config& config, const Stopwatch& watch) {
  const double budget = config.train.time_budget, spent = watch.Seconds();
  if (budget == 0 || spent <= budget / 2) return spent;
  spdlog::warn("{} of the time budget were gone before training; it still gets {}",
               sfm::FormatSeconds(spent), sfm::FormatSeconds(budget / 2));
  return budget / 2;
}

// The exposures that the inspection knows, of the photographs that are trained on.
std::vector<double> StopsOf(const sfm::PosedImages& posed, const Inspection& inspection,
                            const Dataset& data) {
  std::map<std::string, double> stops_of;
  for (std::size_t i = 0; i < inspection.stops.size(); ++i) {
    stops_of[posed.images[i].name] = inspection.stops[i];
  }
  std::vector<double> stops;
  for (const View& view : data.train) {
    if (const auto found = stops_of.find(view.name); found != stops_of.end()) {
      stops.push_back(found->second);
    }
  }
  return stops.size() == data.train.size() ? stops : std::vector<double>();
}

void StartRun(const TrainArguments& arguments, const fs::path& run, int threads,
              const Stopwatch& watch) {
  if (arguments.input.empty()) throw sfm::InputError("nerf train: name an INPUT");
  std::vector<std::string> assignments = AssignmentsOf(arguments);
  const EffectsRequest effects = ParseEffects(arguments.effects);
  assignments.insert(assignments.end(), effects.assignments.begin(), effects.assignments.end());
  Config config = LoadConfig(arguments.preset, assignments);
  RequireOwnFolder(run);
  sfm::FindInput(arguments.input);  // a wrong input must not leave an empty run behind
  sfm::PosedImages found = FindPoses(arguments.input, run, threads);
  WarnOfMissing(found);
  AssignSplits(found, config.data);
  RequireValidation(found, config);
  EffectsChoice choice;
  const std::set<std::string> named = NamedEffects(arguments.preset, assignments);
  const auto take_over_effects = [&] {
    std::vector<std::string> all = assignments;
    all.insert(all.end(), choice.assignments.begin(), choice.assignments.end());
    return LoadConfig(arguments.preset, all);
  };
  if (effects.inspect) {
    choice = ChooseEffects(found, named);
    config = take_over_effects();
  }
  sfm::MakeOutputFolder(run);
  KeepSparsePoints(found, config, run);
  if (effects.inspect) PrintEffects(choice, named);
  const sfm::SceneNormalization normalized_from_world =
      effects.inspect ? choice.inspection.normalized_from_world : sfm::NormalizeScene(found);
  // First, for it marks the folder as a run's own.
  WriteConfig(config, run);
  sfm::WriteTransformsJson(found, PosesPath(run));
  // Read back, so that a run which resumes starts from the same numbers to the last bit.
  const sfm::PosedImages posed = sfm::ReadTransformsJson(PosesPath(run));

  PrintDataPlan(posed, config.data, threads);
  const Dataset data = LoadOrWarn(posed, config, normalized_from_world, run);
  SceneFacts scene = FactsOf(data, normalized_from_world);
  scene.exposure_stops = StopsOf(found, choice.inspection, data);
  if (effects.inspect) {
    TryWhatIsOpen(config, scene, data, named, choice);
    config = take_over_effects();
    WriteConfig(config, run);
    WriteEffects(choice, named, run);
  }
  const double spent = SpentOf(config, watch);
  auto trainer = std::make_unique<Trainer>(config, scene, data, run, spent);
  if (config.train.time_budget > 0 && !arguments.preset_given) {
    const double left = config.train.time_budget - spent;
    const BudgetPlan plan = PlanBudget(*trainer, left);
    fmt::print("time budget {}: preset {}, about {:.0f} steps\n",
               sfm::FormatDuration(config.train.time_budget), plan.preset, plan.steps);
    std::fflush(stdout);
    if (plan.preset != arguments.preset) {
      config = WithEffectsOf(config, LoadConfig(plan.preset, assignments));
      WriteConfig(config, run);
      trainer = std::make_unique<Trainer>(config, scene, data, run, SpentOf(config, watch));
    }
  }
  const TrainSummary summary = trainer->Run(StopOnInterrupt());
  ReportRefinedPoses(trainer->GetModel(), posed, run);
  Report(summary, config.train, run);
}

void ResumeRun(const TrainArguments& arguments, const fs::path& run, int threads,
               const Stopwatch& watch) {
  if (!AssignmentsOf(arguments).empty() || arguments.preset_given) {
    throw sfm::InputError(
        "--resume goes on with the run's own configuration; leave --config, --set, --downscale, "
        "--time-budget and --target-psnr away");
  }
  const Checkpoint checkpoint = ReadRunCheckpoint(run);
  const Model model = ModelFromCheckpoint(checkpoint);
  if (const int before = checkpoint.meta.value("threads", threads); before != threads) {
    spdlog::warn("the run was on {} threads and goes on with {}; sums will round differently",
                 before, threads);
  }
  const sfm::PosedImages posed = sfm::ReadTransformsJson(PosesPath(run));
  WarnOfMissing(posed);
  PrintDataPlan(posed, model.config.data, threads);
  const Dataset data = LoadOrWarn(posed, model.config, model.scene.normalized_from_world, run);
  Trainer trainer(checkpoint, data, run, watch.Seconds());
  const TrainSummary summary = trainer.Run(StopOnInterrupt());
  ReportRefinedPoses(trainer.GetModel(), posed, run);
  Report(summary, model.config.train, run);
}

}  // namespace

void AddTrainCommand(CLI::App& app) {
  auto* command = app.add_subcommand("train", "Trains a radiance field from photographs");
  const auto arguments = std::make_shared<TrainArguments>();
  command->add_option("input", arguments->input,
                      "folder of photos, COLMAP project, transforms.json, or LLFF folder");
  command->add_option("-o,--output", arguments->output, "run folder [runs/INPUT]");
  auto* preset = command
                     ->add_option("--config", arguments->preset,
                                  "preset (fast, balanced, accurate) or JSON file")
                     ->capture_default_str();
  command->add_option("--set", arguments->assignments, "change one key: block.key=value")
      ->allow_extra_args(false)
      ->take_all();
  command
      ->add_option(
          "--effects", arguments->effects,
          "auto: as the capture calls for them; config: as configured; +exposure,-view: so, "
          "and the others auto")
      ->capture_default_str();
  command->add_option("--downscale", arguments->downscale, "reduce photographs by this factor");
  command
      ->add_option("--time-budget", arguments->time_budget,
                   "end after this time: 90, 30s, 2m, 1h; chooses the preset, unless --config does")
      ->transform(
          CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"m", 60}, {"h", 3600}}));
  command->add_option("--target-psnr", arguments->target_psnr,
                      "end when the validation photographs reach so many dB");
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->add_flag("--resume", arguments->resume, "go on with the run in -o");
  command->footer(
      "Ctrl-C saves and leaves; --resume goes on where the run stopped, bit for bit with the same\n"
      "number of threads. A time budget counts from the command's start, poses and reading with "
      "it;\n"
      "runs with one end by the clock, and are not the same to the bit.\n"
      "Examples:\n"
      "  nerf train photos/fox -o runs/fox --downscale 4\n"
      "  nerf train photos/fox/transforms.json --config fast --set train.steps=2000\n"
      "  nerf train photos/fox/transforms.json --time-budget 2m --target-psnr 30\n"
      "  nerf train --resume -o runs/fox");
  command->callback([arguments, preset] {
    const Stopwatch watch;
    arguments->preset_given = preset->count() > 0;
    const int threads = UseThreads(arguments->threads);
    const fs::path run = RunFolder(*arguments);
    arguments->resume ? ResumeRun(*arguments, run, threads, watch)
                      : StartRun(*arguments, run, threads, watch);
  });
}

}  // namespace nerf
