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
#include "nerf/config/options_json.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/material_session.h"

namespace nerf {
namespace {

struct MaterialsArguments {
  std::string environment;
  std::vector<std::string> assignments;
  MaterialRequest request;
  std::string run;
  int threads = 0;
};

// Applies "key=value" of --set.
void Assign(const std::vector<std::string>& assignments, MaterialOptions& options) {
  nlohmann::json json = JsonFromOptions(options);
  for (const std::string& assignment : assignments) {
    const std::size_t at = assignment.find('=');
    const std::string key = assignment.substr(0, at);
    if (at == std::string::npos || !json.contains(key)) {
      throw InputError("--set {}: use KEY=VALUE; the keys are {}", assignment, [&] {
        std::string keys;
        for (const auto& item : json.items()) keys += (keys.empty() ? "" : ", ") + item.key();
        return keys;
      }());
    }
    const nlohmann::json value = nlohmann::json::parse(assignment.substr(at + 1), nullptr, false);
    if (!value.is_number()) throw InputError("--set {}: use a number", assignment);
    if (json[key].is_number_integer() && !value.is_number_integer()) {
      throw InputError("--set {}: use a whole number", assignment);
    }
    json[key] = value;
  }
  OptionsFromJson(json, "materials.", options);
  CheckRanges(options, "materials.");
}

void RunMaterials(MaterialsArguments& arguments) {
  const Stopwatch watch;
  UseThreads(arguments.threads);
  MaterialRequest& request = arguments.request;
  request.run = arguments.run;
  Assign(arguments.assignments, request.options);
  if (!arguments.environment.empty()) request.light = OpenEnvironment(arguments.environment);
  TrainingDisplay display;
  const std::optional<MaterialSession> session = FindMaterials(
      request, watch, StopOnInterrupt(), [&](const PipelineEvent& event) { display(event); });
  display.Finish();
  if (!session) {
    fmt::print("stopped; nothing was written\n");
    return;
  }
  const Materials& found = session->materials;
  fmt::print("{}: a surface of {} vertices, {} steps, {:.2f} dB, {:.1f} s\n",
             session->finished ? "found" : "stopped", found.surface.mesh.vertices.size(),
             found.steps, session->psnr, watch.Seconds());
  if (!request.light) {
    fmt::print(
        "the light is not known, so its brightness and that of the materials are relative: its "
        "mean "
        "is near white\n");
  }
  fmt::print("{}\n{}\nnext: nerf relight {} --environment MAP\n",
             MaterialsPath(request.run).string(), EnvironmentPath(request.run).string(),
             arguments.run);
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
  command->add_option("--steps", request.steps, "of the fit, without a time budget")
      ->check(CLI::Range(1, 1 << 24))
      ->capture_default_str();
  auto* environment = command->add_option(
      "--environment", arguments->environment,
      "the map of the light that shone on the scene [it is found]; a file, or a named light");
  command
      ->add_option("--exposure", request.light_exposure,
                   "stops by which the photographs show this light brighter than the map")
      ->check(CLI::Range(-64.0, 64.0))
      ->capture_default_str()
      ->needs(environment);
  command
      ->add_option("--set", arguments->assignments, "override a value: smoothness=0.02; repeatable")
      ->allow_extra_args(false)
      ->take_all();
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->footer(
      "Needs a subject that is opaque, in photographs of one exposure, which must still be there.\n"
      "The field stays as it is. Examples:\n"
      "  nerf materials runs/chair\n"
      "  nerf materials runs/chair --time-budget 5m\n"
      "  nerf materials runs/chair --environment venice_sunset_1k.hdr --exposure -0.67\n"
      "  nerf relight runs/chair --environment studio_small_03_1k.hdr");
  command->callback([arguments] { RunMaterials(*arguments); });
}

}  // namespace nerf
