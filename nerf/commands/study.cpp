#include "nerf/study/study.h"

#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/interrupt.h"
#include "nerf/base/progress.h"
#include "nerf/commands/commands.h"
#include "nerf/commands/threads.h"
#include "nerf/commands/training_display.h"
#include "nerf/pipeline/prepared_scene.h"
#include "nerf/study/report.h"
#include "sfm/pose_input.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

struct StudyArguments {
  std::string input;
  std::string output;
  StudyOptions options;
  int threads = 0;
};

constexpr double kShortestStudy = 600, kLongestStudy = 30 * 24 * 3600;  // seconds

void PrintFront(const nlohmann::json& results) {
  fmt::print("{:<18} {:>8} {:>9} {:>8} {:>11}\n", "Pareto front", "seconds", "PSNR dB", "SSIM",
             "s per frame");
  std::map<double, const nlohmann::json*> by_seconds;
  for (const auto& setting : results.at("settings")) {
    if (setting.at("on_training_front")) by_seconds[setting.at("seconds")] = &setting;
  }
  for (const auto& [seconds, setting] : by_seconds) {
    const auto& exact = setting->at("qualities").at(0);
    fmt::print("{:<18} {:>8.1f} {:>9.2f} {:>8.4f} {:>11.3f}\n",
               setting->at("name").get<std::string>(), seconds, exact.at("psnr").get<double>(),
               exact.at("ssim").get<double>(), exact.at("seconds_per_frame").get<double>());
  }
}

void RunStudy(const StudyArguments& arguments) {
  UseThreads(arguments.threads);
  const StudyOptions& options = arguments.options;
  if (!(options.budget >= kShortestStudy && options.budget <= kLongestStudy)) {
    throw InputError("--budget: {} s; use 10m to 720h", options.budget);
  }
  if (options.downscale < 1) {
    throw InputError("--downscale {}: use 1 or more", options.downscale);
  }
  sfm::FindInput(arguments.input);  // fails before the output folder is created
  const fs::path folder = arguments.output;
  MakeOutputFolder(folder);
  TrainingDisplay display;
  const PipelineListener listener = [&](const PipelineEvent& event) { display(event); };
  const Config config = LoadConfig("balanced", {});
  PreparedScene scene = PrepareScene(arguments.input, folder, config.data, listener);
  AddMissingPoints(scene, folder, config.data.points_share * options.budget, listener);
  InspectScene(config, {}, scene, listener);
  listener(CaptureInspected{&scene.inspection, {}, scene.inspection_seconds});
  // Steps of single trainings are not shown.
  const PipelineListener setting_listener = [&](const PipelineEvent& event) {
    const bool is_step = std::holds_alternative<TrainerEvent>(event) ||
                         std::holds_alternative<SurfacesRendered>(event) ||
                         std::holds_alternative<GaussiansStepped>(event);
    if (!is_step) display(event);
  };
  Study study(std::move(scene), options, folder, setting_listener);
  fmt::print("{} settings in {} (without poses); Ctrl-C stops, the same command continues\n",
             study.Settings(), FormatDuration(options.budget));
  const bool done = study.Run(StopOnInterrupt(),
                              [&](std::size_t number, const StudySetting& setting, double seconds) {
                                fmt::print("{:>2} of {}: {}, {} of training\n", number + 1,
                                           study.Settings(), setting.name, FormatSeconds(seconds));
                                std::fflush(stdout);
                              });
  if (!done) {
    fmt::print("stopped; finished settings are in {}\n", folder.string());
    return;
  }
  const fs::path page = folder / "study.html";
  WriteFileAtomically(page, StudyReport(study.Results(), folder / "crops"));
  PrintFront(study.Results());
  fmt::print("{}\n", page.string());
}

}  // namespace

void AddStudyCommand(CLI::App& app) {
  auto* command =
      app.add_subcommand("study", "Measures accuracy against time: trains a grid of settings");
  const auto arguments = std::make_shared<StudyArguments>();
  command
      ->add_option("input", arguments->input,
                   "folder of photos, COLMAP project, transforms.json, or LLFF folder")
      ->required();
  command->add_option("-o,--output", arguments->output, "folder for study.json and study.html")
      ->required();
  command->add_option("--budget", arguments->options.budget, "total time, such as 1h [10m]")
      ->transform(
          CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"m", 60}, {"h", 3600}}));
  command
      ->add_option("--downscale", arguments->options.downscale, "reduce photographs by this factor")
      ->capture_default_str();
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->footer(
      "study.html shows PSNR on held-out photographs over training time and time per frame. It\n"
      "needs no network.\n"
      "Examples:\n"
      "  nerf study photos/chair -o studies/chair\n"
      "  nerf study photos/fox/transforms.json -o studies/fox --downscale 4 --budget 1h");
  command->callback([arguments] { RunStudy(*arguments); });
}

}  // namespace nerf
