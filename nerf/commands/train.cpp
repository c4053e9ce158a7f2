#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nerf/commands/commands.h"
#include "nerf/commands/interrupt.h"
#include "nerf/commands/threads.h"
#include "nerf/config.h"
#include "nerf/data/camera.h"
#include "nerf/data/dataset.h"
#include "nerf/train/checkpoint.h"
#include "nerf/train/run_folder.h"
#include "nerf/train/trainer.h"
#include "sfm/atomic_file.h"
#include "sfm/colmap_runner.h"
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
  std::optional<int> downscale;
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

// "a, b, c and 14 more"
std::string SomeOf(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, names.size()); ++i) {
    text += (i > 0 ? ", " : "") + names[i];
  }
  if (names.size() > kShown) text += fmt::format(" and {} more", names.size() - kShown);
  return text;
}

// Poses of the input: read where it brings them, found by COLMAP where it is a folder of photos.
sfm::PosedImages FindPoses(const fs::path& input, const fs::path& run, int threads) {
  const sfm::InputLocation location = sfm::FindInput(input);
  if (location.kind != sfm::InputKind::kPhotos) return sfm::ReadPosedInput(location);
  sfm::ColmapOptions colmap;
  colmap.threads = threads;
  sfm::ColmapReport report;
  sfm::PosedImages posed = sfm::PosesFromPhotos(location.images, ColmapPath(run), colmap, &report);
  if (!report.skipped.empty()) {
    spdlog::warn("{} of {} photographs cannot be read and are left out", report.skipped.size(),
                 report.skipped.size() + report.photos);
  }
  double seconds = 0;
  for (const auto& [step, step_seconds] : report.seconds) seconds += step_seconds;
  fmt::print(
      "poses: {} of {} photographs registered, {} points, reprojection error {:.2f} px, {}\n",
      report.registered, report.photos, report.points, report.mean_reprojection_error,
      sfm::FormatDuration(seconds));
  return posed;
}

// The first line, before anything large is read.
void PrintPlan(const sfm::PosedImages& posed, const DataOptions& options, int threads) {
  const DataPlan plan = PlanData(posed, options);
  int width = 0, height = 0;
  for (const auto& image : posed.images) {
    const sfm::Camera camera = Downscaled(posed.cameras[image.camera], options.downscale);
    width = std::max(width, camera.width);
    height = std::max(height, camera.height);
  }
  const std::string share =
      plan.held == plan.pixels
          ? ""
          : fmt::format(", of every {:.3g} pixels one at random (data.memory_mb allows no more)",
                        static_cast<double>(plan.pixels) / static_cast<double>(plan.held));
  fmt::print(
      "{} threads; {} images to train on, {} to validate, {} held out; {}x{} pixels; {} MB of "
      "pixels held{}\n",
      threads, plan.train, plan.validation, plan.held_out, width, height, plan.Bytes() >> 20,
      share);
  std::fflush(stdout);
}

void WarnOfMissing(const sfm::PosedImages& posed) {
  if (posed.missing.empty()) return;
  spdlog::warn("{}: {} of {} images are missing and left out: {}", posed.source.string(),
               posed.missing.size(), posed.missing.size() + posed.images.size(),
               SomeOf(posed.missing));
}

Dataset Load(const sfm::PosedImages& posed, const DataOptions& options,
             const sfm::SceneNormalization& normalized_from_world) {
  Dataset data = LoadDataset(posed, options, normalized_from_world);
  if (!data.skipped.empty()) {
    for (const std::string& reason : data.skipped) spdlog::warn("{}", reason);
    spdlog::warn("{} images could not be read and are left out", data.skipped.size());
  }
  return data;
}

void Report(const TrainSummary& summary, const fs::path& run) {
  const std::string psnr = summary.validation_psnr > 0
                               ? fmt::format(", validation {:.2f} dB", summary.validation_psnr)
                               : "";
  if (summary.finished) {
    fmt::print("trained {} steps in {:.1f} s{}\n{}\nnext: nerf eval {}\n", summary.step,
               summary.training_seconds, psnr, run.string(), run.string());
  } else {
    fmt::print("stopped at step {}, saved{}\ngo on with: nerf train --resume -o {}\n", summary.step,
               psnr, run.string());
  }
}

void StartRun(const TrainArguments& arguments, const fs::path& run, int threads) {
  if (arguments.input.empty()) throw sfm::InputError("nerf train: name an INPUT");
  std::vector<std::string> assignments = arguments.assignments;
  if (arguments.downscale) {
    assignments.push_back(fmt::format("data.downscale={}", *arguments.downscale));
  }
  const Config config = LoadConfig(arguments.preset, assignments);
  RequireOwnFolder(run);
  sfm::FindInput(arguments.input);  // a wrong input must not leave an empty run behind
  sfm::MakeOutputFolder(run);

  sfm::PosedImages found = FindPoses(arguments.input, run, threads);
  WarnOfMissing(found);
  AssignSplits(found, config.data);
  SceneFacts scene;
  scene.normalized_from_world = sfm::NormalizeScene(found);
  // First, for it marks the folder as a run's own.
  sfm::WriteFileAtomically(ConfigPath(run), JsonFromConfig(config).dump(2) + "\n");
  sfm::WriteTransformsJson(found, PosesPath(run));
  // Read back, so that a run which resumes starts from the same numbers to the last bit.
  const sfm::PosedImages posed = sfm::ReadTransformsJson(PosesPath(run));

  PrintPlan(posed, config.data, threads);
  const Dataset data = Load(posed, config.data, scene.normalized_from_world);
  scene.encoding = data.encoding;
  scene.has_alpha = data.has_alpha;
  Trainer trainer(config, scene, data, run);
  Report(trainer.Run(StopOnInterrupt()), run);
}

void ResumeRun(const TrainArguments& arguments, const fs::path& run, int threads) {
  if (!arguments.assignments.empty() || arguments.downscale || arguments.preset_given) {
    throw sfm::InputError(
        "--resume goes on with the run's own configuration; leave --config, --set and --downscale "
        "away");
  }
  const Checkpoint checkpoint = ReadRunCheckpoint(run);
  const Model model = ModelFromCheckpoint(checkpoint);
  if (const int before = checkpoint.meta.value("threads", threads); before != threads) {
    spdlog::warn("the run was on {} threads and goes on with {}; sums will round differently",
                 before, threads);
  }
  const sfm::PosedImages posed = sfm::ReadTransformsJson(PosesPath(run));
  WarnOfMissing(posed);
  PrintPlan(posed, model.config.data, threads);
  const Dataset data = Load(posed, model.config.data, model.scene.normalized_from_world);
  Trainer trainer(checkpoint, data, run);
  Report(trainer.Run(StopOnInterrupt()), run);
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
  command->add_option("--downscale", arguments->downscale, "reduce photographs by this factor");
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->add_flag("--resume", arguments->resume, "go on with the run in -o");
  command->footer(
      "Ctrl-C saves and leaves; --resume goes on where the run stopped, bit for bit with the same\n"
      "number of threads.\n"
      "Examples:\n"
      "  nerf train photos/fox -o runs/fox --downscale 4\n"
      "  nerf train photos/fox/transforms.json --config fast --set train.steps=2000\n"
      "  nerf train --resume -o runs/fox");
  command->callback([arguments, preset] {
    arguments->preset_given = preset->count() > 0;
    const int threads = UseThreads(arguments->threads);
    const fs::path run = RunFolder(*arguments);
    arguments->resume ? ResumeRun(*arguments, run, threads) : StartRun(*arguments, run, threads);
  });
}

}  // namespace nerf
