#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <string>

#include "nerf/base/stopwatch.h"
#include "nerf/commands/commands.h"
#include "nerf/commands/threads.h"
#include "nerf/pipeline/training_run.h"

namespace nerf {

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
      "  nerf train photos/fox --effects +exposure,-view\n"
      "  nerf train --resume -o runs/fox");
  command->callback([arguments, preset] {
    const Stopwatch watch;
    arguments->preset_given = preset->count() > 0;
    const int threads = UseThreads(arguments->threads);
    (arguments->resume ? ResumeRun : StartRun)(*arguments, threads, watch);
  });
}

}  // namespace nerf
