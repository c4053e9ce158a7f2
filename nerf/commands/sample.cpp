#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "nerf/commands/commands.h"
#include "nerf/commands/light_stage_flags.h"
#include "nerf/synthetic/sample_folder.h"

namespace nerf {
namespace {

struct SampleArguments {
  LightStageFlags light_stage;
  std::string folder;
  synthetic::SampleOptions options;
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
  command->footer(
      "Examples:\n"
      "  nerf sample demo                             36 photographs in demo/images\n"
      "  nerf train demo                              then train on them\n"
      "  nerf sample demo --views 60 --width 800 --height 600\n"
      "  nerf sample drift --scenario exposure        exposure and white balance vary\n"
      "  nerf sample far --scenario anti_aliasing     half of the cameras are four times as far "
      "away\n"
      "  nerf sample loose --scenario pose_refinement slightly wrong poses, and the true ones\n"
      "  nerf sample stage --light-stage 256          one light at a time, for nerf relight");
  command->callback([arguments, views] {
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
