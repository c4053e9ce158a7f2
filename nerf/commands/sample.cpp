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
  std::string calls_for = "built-in";
  synthetic::SampleOptions options;
};

void RunSample(const SampleArguments& arguments) {
  const std::filesystem::path folder = arguments.folder;
  synthetic::WriteSample(folder, arguments.options);
  fmt::print(
      "{} photographs are in {}; true poses, depth, normals and albedo, for tests only, in {}\n"
      "next: nerf train {}\n",
      arguments.options.views, (folder / "images").string(), (folder / "truth").string(),
      folder.string());
}

}  // namespace

void AddSampleCommand(CLI::App& app) {
  auto arguments = std::make_shared<SampleArguments>();
  synthetic::SampleOptions& options = arguments->options;
  CLI::App* command =
      app.add_subcommand("sample", "Photographs of a small built-in scene, to train on");
  command
      ->add_option("folder", arguments->folder, "where the photographs go: new, empty, or a sample")
      ->required();
  command
      ->add_option("--calls-for", arguments->calls_for,
                   "a capture that calls for one effect: " + synthetic::OccasionNames())
      ->capture_default_str();
  const CLI::Option* const views = command->add_option(
      "--views", options.views, "how many photographs [36; few where they call for depth]");
  command->add_option("--width", options.width, "of a photograph, in pixels")
      ->capture_default_str();
  command->add_option("--height", options.height, "of a photograph, in pixels")
      ->capture_default_str();
  command->add_option("--samples", options.samples_per_pixel, "rays averaged in each pixel")
      ->capture_default_str();
  command->add_option("--seed", options.seed, "another number moves the cameras a little")
      ->capture_default_str();
  command->add_option("--threads", options.threads, "0: all cores")->capture_default_str();
  AddLightStageFlags(*command, arguments->light_stage);
  command->footer(
      "Examples:\n"
      "  nerf sample stage --light-stage 256       one light at a time, for nerf relight\n"
      "  nerf sample demo                          36 photographs in demo/images\n"
      "  nerf sample demo --views 60 --width 800 --height 600\n"
      "  nerf sample drift --calls-for exposure    exposure and white balance change\n"
      "  nerf sample far --calls-for footprint     half of the cameras stand four times as far\n"
      "  nerf sample loose --calls-for poses       poses a little wrong; the true ones beside\n"
      "  nerf train demo                           then train on them");
  command->callback([arguments, views] {
    const synthetic::Occasion occasion = synthetic::OccasionFromName(arguments->calls_for);
    arguments->options.occasion = occasion;
    if (views->count() == 0) arguments->options.views = synthetic::UsualViews(occasion);
    if (arguments->light_stage.Given()) {
      RunLightStage(arguments->folder, arguments->light_stage, arguments->options.width,
                    arguments->options.height, arguments->options.threads);
    } else {
      RunSample(*arguments);
    }
  });
}

}  // namespace nerf
