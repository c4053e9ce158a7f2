#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/interrupt.h"
#include "nerf/base/progress.h"
#include "nerf/commands/commands.h"
#include "nerf/commands/threads.h"
#include "nerf/commands/training_display.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/gaussian_session.h"
#include "nerf/splats/gaussian_ply.h"

namespace nerf {
namespace {

struct SplatArguments {
  std::optional<std::string> ply;
  GaussianRequest request;
  std::string run;
  int threads = 0;
};

// Of an option: what is wrong with it; empty: nothing. CLI::PositiveNumber lets NaN pass.
std::string RefuseUnlessPositive(const std::string& text) {
  const double value = std::strtod(text.c_str(), nullptr);
  return value > 0 && std::isfinite(value) ? "" : text + ": use a number above 0";
}

void WritePly(const SplatArguments& arguments) {
  if (arguments.ply->empty()) throw InputError("--ply: name the file to write, like scene.ply");
  const std::shared_ptr<const GaussianModel> model = OpenGaussians(arguments.run);
  if (ReadInterruptedFit(GaussiansPath(arguments.run))) {
    spdlog::warn("{}: the fit was interrupted after {} iterations; --resume would end it",
                 GaussiansPath(arguments.run).string(), model->Step());
  }
  WriteGaussianPly(*arguments.ply, model->Cloud(), model->Scene().normalized_from_world);
  fmt::print("{} Gaussians in {}\n", model->Cloud().count, *arguments.ply);
}

void RunSplat(SplatArguments& arguments) {
  if (arguments.ply) {
    WritePly(arguments);
    return;
  }
  const GaussianRequest& request = arguments.request;
  const bool has_options = !request.assignments.empty() || request.megabytes > 0;
  if (request.resume && (has_options || request.seconds_per_frame > 0)) {
    throw InputError(
        "--resume continues with the options of the fit; omit --set, --megabytes and "
        "--seconds-per-frame");
  }
  const Stopwatch watch;
  UseThreads(arguments.threads);
  arguments.request.run = arguments.run;
  TrainingDisplay display;
  const std::optional<GaussianSession> session =
      MakeGaussians(arguments.request, watch, StopOnInterrupt(),
                    [&](const PipelineEvent& event) { display(event); });
  if (!session) {
    display.Finish();
    fmt::print("stopped; nothing was written\n");
    return;
  }
  display(GaussiansEnded{session->fit, session->reached});
  if (!session->fit.finished) {
    fmt::print("continue with: nerf splat --resume {}\n", arguments.run);
    return;
  }
  fmt::print("{}\nnext: nerf render {} --with splats\n", GaussiansPath(arguments.run).string(),
             arguments.run);
}

}  // namespace

void AddSplatCommand(CLI::App& app) {
  auto* command = app.add_subcommand(
      "splat", "Makes Gaussians of a trained run, which are drawn in milliseconds");
  const auto arguments = std::make_shared<SplatArguments>();
  command->add_option("run", arguments->run, "run folder")->required();
  auto* budget =
      command
          ->add_option("--time-budget", arguments->request.time_budget,
                       "end the fit after this time: 90, 30s, 2m, 1h [splats.steps iterations]")
          ->transform(CLI::AsNumberWithUnit(
              std::map<std::string, double>{{"s", 1}, {"m", 60}, {"h", 3600}}))
          ->check(CLI::Range(1.0, 30.0 * 24 * 3600));
  auto* set = command
                  ->add_option("--set", arguments->request.assignments,
                               "override a value: splats.count=100000; repeatable")
                  ->allow_extra_args(false)
                  ->take_all();
  auto* megabytes = command
                        ->add_option("--megabytes", arguments->request.megabytes,
                                     "as many Gaussians as a PLY file of this size has "
                                     "[splats.count]")
                        ->check(RefuseUnlessPositive);
  auto* frame = command
                    ->add_option("--seconds-per-frame", arguments->request.seconds_per_frame,
                                 "at most as many as this machine draws in this time, at the "
                                 "resolution of the photographs: 0.005")
                    ->check(RefuseUnlessPositive);
  auto* resume =
      command->add_flag("--resume", arguments->request.resume,
                        "continue a fit that was interrupted, with its options and its plan");
  command
      ->add_option("--ply", arguments->ply,
                   "make none, but write those of the run to this file, for other programs")
      ->excludes(resume)
      ->excludes(budget)
      ->excludes(megabytes)
      ->excludes(frame)
      ->excludes(set);
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->footer(
      "They begin at the surfaces that the field renders, and are fitted to the photographs of "
      "the\n"
      "run, which must still be there. The field stays as it is.\n"
      "Examples:\n"
      "  nerf splat runs/fox\n"
      "  nerf splat runs/fox --time-budget 2m --set splats.count=100000\n"
      "  nerf splat runs/fox --megabytes 10\n"
      "  nerf splat runs/fox --seconds-per-frame 0.005\n"
      "  nerf splat runs/fox --ply fox.ply\n"
      "  nerf render runs/fox --with splats --path orbit");
  command->callback([arguments] { RunSplat(*arguments); });
}

}  // namespace nerf
