#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/interrupt.h"
#include "nerf/base/stopwatch.h"
#include "nerf/commands/commands.h"
#include "nerf/commands/threads.h"
#include "nerf/commands/training_display.h"
#include "nerf/pipeline/training_session.h"
#include "sfm/film.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

struct TrainArguments {
  std::string input;
  std::string output;
  std::string preset = "balanced";
  bool preset_is_given = false;
  std::vector<std::string> assignments;
  std::string effects = "auto";
  std::string representation;
  std::optional<int> downscale;
  std::optional<int> frames;
  std::optional<double> time_budget;  // seconds
  std::optional<double> target_psnr;  // dB
  int threads = 0;
  bool materials = false;
  std::string lights;
  bool resume = false;
  bool help_config = false;
};

fs::path RunFolder(const TrainArguments& arguments) {
  if (!arguments.output.empty()) return arguments.output;
  if (arguments.input.empty()) {
    throw InputError("nerf train: give an INPUT, or --resume with -o RUN");
  }
  fs::path name = fs::absolute(arguments.input).lexically_normal();
  if (!name.has_filename()) name = name.parent_path();  // a slash at the end
  // photos/fox/transforms.json is named fox.
  if (name.extension() == ".json") name = name.parent_path();
  if (sfm::HasFilmExtension(name)) name.replace_extension();
  return fs::path("runs") / name.filename();
}

// The assignments by --set and by the flags that are short for it.
std::vector<std::string> AssignmentsOf(const TrainArguments& arguments) {
  std::vector<std::string> assignments = arguments.assignments;
  if (!arguments.representation.empty()) {
    assignments.push_back("train.representation=" + arguments.representation);
  }
  if (arguments.downscale) {
    assignments.push_back(fmt::format("data.downscale={}", *arguments.downscale));
  }
  if (arguments.frames) {
    assignments.push_back(fmt::format("data.film_frames={}", *arguments.frames));
  }
  if (arguments.time_budget) {
    assignments.push_back(fmt::format("train.time_budget={}", *arguments.time_budget));
  }
  if (arguments.materials) assignments.push_back("materials={}");
  if (arguments.target_psnr) {
    assignments.push_back(fmt::format("train.target_psnr={}", *arguments.target_psnr));
  }
  return assignments;
}

TrainingRequest RequestOf(const TrainArguments& arguments) {
  TrainingRequest request;
  request.run = RunFolder(arguments);
  request.assignments = AssignmentsOf(arguments);
  if (arguments.resume) {
    if (!request.assignments.empty() || arguments.preset_is_given || arguments.effects != "auto" ||
        !arguments.lights.empty()) {
      throw InputError(
          "--resume continues with the run's configuration; omit --config, --set, --effects, "
          "--representation, --downscale, --frames, --materials, --lights, --time-budget and "
          "--target-psnr");
    }
    return request;
  }
  if (arguments.input.empty()) throw InputError("nerf train: give an INPUT");
  request.input = arguments.input;
  request.preset = arguments.preset;
  request.preset_is_given = arguments.preset_is_given;
  request.effects = ParseEffects(arguments.effects);
  request.lights = arguments.lights;
  return request;
}

void RunTrain(const TrainArguments& arguments) {
  if (arguments.help_config) {
    fmt::print("{}", ConfigHelpTable());
    return;
  }
  const Stopwatch watch;
  UseThreads(arguments.threads);
  TrainingRequest request = RequestOf(arguments);
  TrainingDisplay display;
  const PipelineListener listener = [&](const PipelineEvent& event) {
    // What comes before training cannot be saved, so Ctrl-C ends it at once.
    if (std::holds_alternative<TrainingBegan>(event)) StopOnInterrupt();
    display(event);
  };
  const std::unique_ptr<TrainingSession> session =
      arguments.resume ? TrainingSession::Resume(request.run, watch, listener)
                       : std::make_unique<TrainingSession>(std::move(request), watch, listener);
  session->Run(StopRequested());
}

void AddMaterialFlags(CLI::App& command, TrainArguments& arguments) {
  auto* materials = command.add_flag(
      "--materials", arguments.materials,
      "then find the materials of the surface and the light on it (nerf materials)");
  command
      .add_option("--lights", arguments.lights,
                  "a lights.json: what is known of the lights on the photographs")
      ->needs(materials);
}

}  // namespace

void AddTrainCommand(CLI::App& app) {
  auto* command = app.add_subcommand("train", "Trains a radiance field from photographs");
  const auto arguments = std::make_shared<TrainArguments>();
  command->add_option("input", arguments->input,
                      "folder of photos, film, COLMAP project, transforms.json, or LLFF folder");
  command->add_option("-o,--output", arguments->output, "run folder [runs/INPUT]");
  auto* preset = command
                     ->add_option("--config", arguments->preset,
                                  "preset (fast, balanced, accurate) or JSON file")
                     ->capture_default_str();
  command->add_option("--set", arguments->assignments, "change one key: block.key=value")
      ->allow_extra_args(false)
      ->take_all();
  command
      ->add_option("--effects", arguments->effects,
                   "auto: decide by inspection and trials; config: as configured; "
                   "+exposure,-view_dependence: these on and off, the others auto")
      ->capture_default_str();
  command
      ->add_option("--representation", arguments->representation,
                   "field: the neural field alone; splats: Gaussians as well, which begin at its "
                   "surfaces; auto: what a short trial says [auto]")
      ->check(CLI::IsMember({"auto", "field", "splats"}));
  AddMaterialFlags(*command, *arguments);
  command->add_option("--downscale", arguments->downscale, "reduce photographs by this factor");
  command->add_option("--frames", arguments->frames,
                      "of a film: how many to use [three a second, 40 to 150]");
  command
      ->add_option("--time-budget", arguments->time_budget,
                   "end after this time: 90, 30s, 2m, 1h; chooses the preset without --config")
      ->transform(
          CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"m", 60}, {"h", 3600}}));
  command->add_option("--target-psnr", arguments->target_psnr,
                      "end when the PSNR on validation photographs reaches this, dB");
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->add_flag("--resume", arguments->resume, "continue the run in -o");
  command->add_flag("--help-config", arguments->help_config,
                    "list every key of the configuration with its default, range and meaning");
  command->footer(
      "Ctrl-C saves and exits; --resume continues the run, with the same result bit for bit if "
      "the\n"
      "number of threads is the same. A time budget is for the whole command, including poses and\n"
      "reading photographs; such runs are not reproducible bit for bit.\n"
      "Examples:\n"
      "  nerf train photos/fox -o runs/fox --downscale 4\n"
      "  nerf train photos/fox/transforms.json --config fast --set train.steps=2000\n"
      "  nerf train photos/fox/transforms.json --time-budget 2m --target-psnr 30\n"
      "  nerf train photos/fox --effects +exposure,-view_dependence\n"
      "  nerf train clip.mp4 --frames 100\n"
      "  nerf train photos/mug --materials --time-budget 10m\n"
      "  nerf train --resume -o runs/fox");
  command->callback([arguments, preset] {
    arguments->preset_is_given = preset->count() > 0;
    RunTrain(*arguments);
  });
}

}  // namespace nerf
