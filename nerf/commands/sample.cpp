#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "nerf/base/interrupt.h"
#include "nerf/base/stopwatch.h"
#include "nerf/commands/commands.h"
#include "nerf/commands/light_stage_flags.h"
#include "nerf/commands/threads.h"
#include "nerf/synthetic/relightable_folder.h"
#include "nerf/synthetic/sample_folder.h"

namespace nerf {
namespace {

struct SampleArguments {
  LightStageFlags light_stage;
  std::string folder;
  synthetic::SampleOptions options;
  int relightable = 0;  // lights; 0: another capture
};

void RunSample(const SampleArguments& arguments) {
  const std::filesystem::path folder = arguments.folder;
  synthetic::WriteSample(folder, arguments.options);
  fmt::print(
      "wrote {} photographs to {}, and ground truth (poses, depth, normals, albedo) to {}\n"
      "next: nerf train {}\n",
      arguments.options.views, (folder / "images").string(), (folder / "truth").string(),
      folder.string());
}

// Of a relightable capture: options that were given replace its own.
void RunRelightable(const SampleArguments& arguments, const CLI::App& command) {
  const Stopwatch watch;
  UseThreads(arguments.options.threads);
  synthetic::RelightableOptions options;
  options.lights = arguments.relightable;
  const auto take = [&](const char* flag, int given, int& own) {
    if (command.count(flag) > 0) own = given;
  };
  take("--views", arguments.options.views, options.views);
  take("--width", arguments.options.width, options.width);
  take("--height", arguments.options.height, options.height);
  take("--samples", arguments.options.samples_per_pixel, options.paths);
  const auto& stop = StopOnInterrupt();
  if (!synthetic::WriteRelightable(arguments.folder, options, [&] { return !stop; })) {
    fmt::print("stopped; the capture in {} is incomplete\n", arguments.folder);
    throw CLI::RuntimeError(130);
  }
  fmt::print(
      "wrote {} photographs, and {} held-out views with their truth, to {} in {:.1f} s\n"
      "next: nerf train {} -o RUN --materials, then nerf eval RUN --truth {}\n",
      options.views, options.test_views, arguments.folder, watch.Seconds(), arguments.folder,
      arguments.folder);
}

void AddScenarioOption(CLI::App& command, synthetic::Scenario& scenario) {
  command
      .add_option_function<std::string>(
          "--scenario,--calls-for",
          [&scenario](const std::string& name) { scenario = synthetic::ScenarioFromName(name); },
          "what the capture calls for: " + synthetic::ScenarioNames() +
              "; --calls-for is the old name of this flag and will be removed in the next version")
      ->default_str("built-in");
}

}  // namespace

void AddSampleCommand(CLI::App& app) {
  auto arguments = std::make_shared<SampleArguments>();
  synthetic::SampleOptions& options = arguments->options;
  CLI::App* command = app.add_subcommand(
      "sample", "Generates photographs of a small built-in scene, for a first training and tests");
  command
      ->add_option("folder", arguments->folder,
                   "output folder: new, empty, or an existing sample, which is replaced")
      ->required();
  AddScenarioOption(*command, options.scenario);
  const CLI::Option* const views =
      command->add_option("--views", options.views,
                          "number of photographs [36; depth_supervision: 10, anti_aliasing: 64]");
  command->add_option("--width", options.width, "of a photograph, pixels")->capture_default_str();
  command->add_option("--height", options.height, "of a photograph, pixels")->capture_default_str();
  command->add_option("--samples", options.samples_per_pixel, "rays averaged per pixel")
      ->capture_default_str();
  command->add_option("--seed", options.seed, "of camera positions and noise")
      ->capture_default_str();
  command->add_option("--threads", options.threads, "0: all cores")->capture_default_str();
  AddLightStageFlags(*command, arguments->light_stage);
  command
      ->add_option("--relightable", arguments->relightable,
                   "instead of a sample: objects of known materials, photographed under this many "
                   "lights in turn [1], with truth of materials and relit views; --samples are "
                   "light paths [64], --views 40, 160x160 pixels")
      ->expected(0, 1)
      ->default_str("1")
      ->check(CLI::Range(1, 3))
      ->excludes(command->get_option("--light-stage"))
      ->excludes(command->get_option("--scenario"))
      ->excludes(command->get_option("--seed"));
  command->footer(
      "Examples:\n"
      "  nerf sample demo                             36 photographs in demo/images\n"
      "  nerf train demo                              then train on them\n"
      "  nerf sample demo --views 60 --width 800 --height 600\n"
      "  nerf sample drift --scenario exposure        exposure and white balance vary\n"
      "  nerf sample far --scenario anti_aliasing     half of the cameras are four times as far "
      "away\n"
      "  nerf sample loose --scenario pose_refinement slightly wrong poses, and the true ones\n"
      "  nerf sample stage --light-stage 256          one light at a time, for nerf relight\n"
      "  nerf sample still --relightable              known materials, for nerf train --materials");
  command->callback([arguments, views, command] {
    if (command->count("--relightable") > 0) {
      RunRelightable(*arguments, *command);
      return;
    }
    if (views->count() == 0) {
      arguments->options.views = synthetic::DefaultViewCount(arguments->options.scenario);
    }
    if (arguments->light_stage.Given()) {
      RunLightStage(arguments->folder, arguments->light_stage, arguments->options.width,
                    arguments->options.height, arguments->options.threads);
    } else {
      RunSample(*arguments);
    }
  });
}

}  // namespace nerf
