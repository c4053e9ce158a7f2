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
      "instead of a sample: images of a subject under this many lights, one at a time, for nerf "
      "relight");
  flags.light_stage = stage;
  // Flags that would be ignored are an error.
  for (const char* sample_flag : {"--views", "--samples", "--seed", "--scenario"}) {
    stage->excludes(command.get_option(sample_flag));
  }
  CLI::Option* environment = command.add_option(
      "--environment", options.environment,
      "with --light-stage: a map; truth/direct.exr is the subject rendered directly under it");
  environment->needs(stage);
  command
      .add_option("--paths", options.paths,
                  "with --environment: light paths for each of the four samples per pixel of "
                  "truth/direct.exr")
      ->capture_default_str()
      ->needs(environment);
  command
      .add_option("--merl", options.merl,
                  "with --light-stage: a measured BRDF in the binary format of MERL, instead of "
                  "that of the gold ball")
      ->needs(stage);
  command
      .add_option("--bounces", options.terms.bounces,
                  "with --light-stage: indirect bounces; above 0 the images are noisy")
      ->capture_default_str()
      ->needs(stage);
  command
      .add_flag("!--no-shadows", options.terms.shadows,
                "with --light-stage: light passes through surfaces")
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
    fmt::print("stopped; the capture in {} is incomplete\n", folder.string());
    throw CLI::RuntimeError(130);
  }
  fmt::print(
      "wrote {} images, each under one light, to {} in {:.1f} s\n"
      "next: nerf relight {} --environment MAP\n",
      options.lights, folder.string(), watch.Seconds(), folder.string());
}

}  // namespace nerf
