#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/interrupt.h"
#include "nerf/commands/commands.h"
#include "nerf/commands/environment_option.h"
#include "nerf/commands/threads.h"
#include "nerf/commands/training_display.h"
#include "nerf/config/config.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/material_session.h"

namespace nerf {
namespace {

struct MaterialsArguments {
  std::string environment, lights, photographs;
  double exposure = 0;  // stops
  std::vector<std::string> assignments;
  std::optional<int> steps;
  MaterialRequest request;
  std::string run;
  int threads = 0;
};

// With the keys of the block materials that --set gives, with or without its name.
MaterialOptions OptionsOf(const std::vector<std::string>& assignments) {
  std::vector<std::string> all = {"materials={}"};
  for (const std::string& assignment : assignments) {
    all.push_back(assignment.starts_with("materials.") ? assignment : "materials." + assignment);
  }
  return *LoadConfig("base", all).materials;
}

// The one light that --environment names; nullopt: none.
std::optional<LightPlan> LightsOf(const MaterialsArguments& arguments) {
  if (!arguments.lights.empty()) return ReadLightPlan(arguments.lights);
  if (arguments.environment.empty()) return std::nullopt;
  PlannedLight light;
  light.environment = OpenEnvironment(arguments.environment);
  light.exposure = arguments.exposure;
  return LightPlan{{std::move(light)}, {}};
}

void RunMaterials(MaterialsArguments& arguments) {
  const Stopwatch watch;
  UseThreads(arguments.threads);
  MaterialRequest& request = arguments.request;
  request.run = arguments.run;
  if (request.resume && (arguments.steps || request.time_budget > 0 || !arguments.lights.empty() ||
                         !arguments.environment.empty() || !arguments.photographs.empty() ||
                         !arguments.assignments.empty())) {
    throw InputError(
        "--resume continues a fit as it was planned; omit --steps, --time-budget, --environment, "
        "--lights, --photographs and --set");
  }
  request.photographs = arguments.photographs;
  request.options = OptionsOf(arguments.assignments);
  if (arguments.steps) request.options.steps = *arguments.steps;
  request.lights = LightsOf(arguments);
  TrainingDisplay display;
  const std::optional<MaterialsFound> found = FindMaterials(
      request, watch, StopOnInterrupt(), [&](const PipelineEvent& event) { display(event); });
  display.Finish();
  if (!found) {
    fmt::print("stopped; nothing was written\n");
    return;
  }
  display(*found);
  if (!found->finished) {
    fmt::print("continue with: nerf materials --resume {}\n", arguments.run);
    return;
  }
  fmt::print("{}, {:.1f} s in all\nnext: nerf relight {} --environment MAP\n",
             MaterialsPath(request.run).string(), watch.Seconds(), arguments.run);
}

}  // namespace

void AddMaterialsCommand(CLI::App& app) {
  auto* command = app.add_subcommand(
      "materials", "Finds the surface, the materials and the light of a trained run");
  const auto arguments = std::make_shared<MaterialsArguments>();
  MaterialRequest& request = arguments->request;
  command->add_option("run", arguments->run, "run folder")->required();
  command
      ->add_option("--time-budget", request.time_budget,
                   "end after this time: 90, 30s, 2m, 1h [--steps]")
      ->transform(
          CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"m", 60}, {"h", 3600}}))
      ->check(CLI::Range(1.0, 30.0 * 24 * 3600));
  command
      ->add_option("--steps", arguments->steps,
                   "of the fit, without a time budget [materials.steps]")
      ->check(CLI::Range(1, 1 << 24));
  auto* environment = command->add_option(
      "--environment", arguments->environment,
      "the map of the light that shone on the scene [it is found]; a file, or a named light");
  command
      ->add_option("--exposure", arguments->exposure,
                   "stops by which the photographs show this light brighter than the map")
      ->check(CLI::Range(-64.0, 64.0))
      ->capture_default_str()
      ->needs(environment);
  command
      ->add_option("--lights", arguments->lights,
                   "a lights.json: environments, suns and points, and which photographs they "
                   "shine on")
      ->excludes(environment);
  command->add_option("--photographs", arguments->photographs,
                      "a transforms.json of other photographs, posed in the same world; its frames "
                      "may name their lights [those of the run]");
  command
      ->add_option("--set", arguments->assignments,
                   "change one key of the block materials: smoothness=0.02, specular=off; "
                   "repeatable")
      ->allow_extra_args(false)
      ->take_all();
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->add_flag("--resume", request.resume, "continue a fit that was interrupted");
  command->footer(
      "Needs a subject that is opaque, in photographs of one exposure, which must still be there.\n"
      "The field stays as it is. Examples:\n"
      "  nerf materials runs/chair\n"
      "  nerf materials runs/chair --time-budget 5m\n"
      "  nerf materials runs/chair --environment venice_sunset_1k.hdr --exposure -0.67\n"
      "  nerf materials runs/chair --lights lights.json\n"
      "  nerf materials runs/chair --photographs stage/transforms.json\n"
      "  nerf relight runs/chair --environment studio_small_03_1k.hdr");
  command->callback([arguments] { RunMaterials(*arguments); });
}

}  // namespace nerf
