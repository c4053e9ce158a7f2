#include "nerf/commands/light_stage_flags.h"

#include <spdlog/fmt/fmt.h>

#include "nerf/base/interrupt.h"
#include "nerf/base/stopwatch.h"
#include "nerf/commands/threads.h"

namespace nerf {

void AddLightStageFlags(CLI::App& command, LightStageFlags& flags) {
  synthetic::LightStageOptions& options = flags.options;
  CLI::Option* stage = command.add_option(
      "--light-stage", options.lights,
      "instead: a subject on a table under so many lights, one at a time, for nerf relight");
  flags.light_stage = stage;
  // What would be ignored without a word.
  for (const char* ordinary : {"--views", "--samples", "--seed", "--calls-for"}) {
    stage->excludes(command.get_option(ordinary));
  }
  CLI::Option* environment = command.add_option(
      "--environment", options.environment,
      "with --light-stage: a map; the subject directly under it is truth/direct.exr");
  environment->needs(stage);
  command
      .add_option("--paths", options.paths,
                  "with --environment: of light, in each quarter of a pixel of that picture")
      ->capture_default_str()
      ->needs(environment);
  command
      .add_option(
          "--merl", options.merl,
          "with --light-stage: a measured BRDF in MERL's binary format, for the ball of gold")
      ->needs(stage);
  command
      .add_option("--bounces", options.terms.bounces,
                  "with --light-stage: further surfaces that light may visit; above 0 it is noisy")
      ->capture_default_str()
      ->needs(stage);
  command.add_flag("!--no-shadows", options.terms.shadows, "with --light-stage: light all through")
      ->needs(stage);
}

void RunLightStage(const std::filesystem::path& folder, const LightStageFlags& flags, int width,
                   int height, int threads) {
  const Stopwatch watch;
  UseThreads(threads);
  const auto& stop = StopOnInterrupt();
  synthetic::LightStageOptions options = flags.options;
  options.width = width;
  options.height = height;
  if (!synthetic::WriteLightStage(folder, options, [&] { return !stop; })) {
    fmt::print("stopped; {} holds no whole capture\n", folder.string());
    throw CLI::RuntimeError(130);
  }
  fmt::print(
      "{} images under one light each are in {}, {:.1f} s\n"
      "next: nerf relight {} --environment MAP\n",
      options.lights, folder.string(), watch.Seconds(), folder.string());
}

}  // namespace nerf
