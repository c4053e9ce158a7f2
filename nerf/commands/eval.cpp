#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/progress.h"
#include "nerf/commands/commands.h"
#include "nerf/commands/evaluation_report.h"
#include "nerf/commands/model_choice.h"
#include "nerf/commands/threads.h"
#include "nerf/commands/training_display.h"
#include "nerf/image/image_io.h"
#include "nerf/model/evaluation.h"
#include "nerf/model/run_folder.h"
#include "nerf/output/contact_sheet.h"
#include "nerf/pipeline/effect_measurement.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

struct EvalArguments {
  std::string run;
  std::string output;
  std::string split = "test";
  std::string with = "auto";
  double quality = 1;
  bool fit_exposure = false;
  std::optional<int> downscale;
  bool effects = false;
  int effects_steps = 500;
  std::string truth, maps;
  int bounces = 2;
  int threads = 0;
  bool json = false;
};

// Rows of the contact sheet, to bound its memory.
constexpr std::size_t kMaxRows = 50;

Split SplitFromName(const std::string& name) {
  if (name == "train") return Split::kTrain;
  return name == "validation" ? Split::kValidation : Split::kTest;
}

// The materials of a run that has some, under one light: of several it is not known which shone on
// a held-out photograph.
std::optional<Materials> MaterialsOfOneLight(const fs::path& run) {
  if (!fs::exists(MaterialsPath(run))) return std::nullopt;
  Materials materials = ReadMaterials(MaterialsPath(run));
  if (materials.surface.lights.size() == 1) return materials;
  spdlog::warn("the effects of light are not measured: the run has {} lights",
               materials.surface.lights.size());
  return std::nullopt;
}

LightEffectMeasurements LightEffectsOf(const OpenedRun& run, const Materials& materials) {
  std::optional<ProgressLine> progress;
  return MeasureLightEffects(run, materials, [&](std::size_t done, std::size_t of) {
    if (!progress) progress.emplace("relighting", static_cast<std::int64_t>(of));
    progress->Update(static_cast<std::int64_t>(done));
  });
}

void EvaluateEffects(const OpenedRun& run, const EvalArguments& arguments, const fs::path& output) {
  const std::optional<Materials> materials = MaterialsOfOneLight(arguments.run);
  TrainingDisplay display;
  std::optional<ProgressLine> progress;
  const std::vector<EffectMeasurement> effects = MeasureEffects(
      run, arguments.effects_steps, [&](const PipelineEvent& event) { display(event); },
      [&](std::size_t done, std::size_t trainings, const EffectDescriptor& effect) {
        if (!progress) progress.emplace("measuring", static_cast<std::int64_t>(trainings));
        progress->Update(static_cast<std::int64_t>(done), effect.name);
      });
  progress.reset();
  nlohmann::json result = JsonFromMeasurements(effects, arguments.effects_steps);
  std::optional<LightEffectMeasurements> of_light;
  if (materials) of_light = LightEffectsOf(run, *materials);
  if (of_light) result["light"] = JsonFromLightEffects(*of_light);
  WriteFileAtomically(output / "effects_worth.json", result.dump(2) + "\n");
  if (arguments.json) {
    fmt::print("{}\n", result.dump(2));
  } else {
    PrintMeasurements(effects, arguments.effects_steps);
    if (of_light) PrintLightEffects(*of_light);
  }
}

void EvaluateTruth(const OpenedRun& run, const EvalArguments& arguments, const fs::path& output) {
  const TruthFolder truth = ReadTruthFolder(arguments.truth, arguments.maps);
  std::optional<ProgressLine> progress;
  const TruthComparison comparison =
      CompareWithTruth(run, ReadMaterials(MaterialsPath(arguments.run)), truth, arguments.bounces,
                       [&](std::size_t done, std::size_t of) {
                         if (!progress) {
                           progress.emplace("comparing", static_cast<std::int64_t>(of));
                         }
                         progress->Update(static_cast<std::int64_t>(done));
                       });
  progress.reset();
  const nlohmann::json result = JsonFromComparison(comparison);
  WriteFileAtomically(output / "truth.json", result.dump(2) + "\n");
  if (arguments.json) {
    fmt::print("{}\n", result.dump(2));
  } else {
    PrintComparison(comparison);
  }
}

// Evaluates the views of the split and writes the contact sheet.
Evaluation EvaluateViews(const OpenedRun& run, const SceneModel& model,
                         const EvalArguments& arguments, const fs::path& output) {
  const std::vector<const PosedImage*> images = ImagesOf(run.posed, SplitFromName(arguments.split));
  if (images.empty()) {
    throw InputError("{}: the run has no {} images; choose another --split", arguments.run,
                     arguments.split);
  }
  if (arguments.downscale && *arguments.downscale < 1) {
    throw InputError("--downscale {}: use 1 or more", *arguments.downscale);
  }
  ProgressLine progress("evaluating", static_cast<std::int64_t>(images.size()));
  std::vector<ContactSheetRow> rows;
  std::int64_t done = 0;
  const Evaluation evaluation = Evaluate(
      model, run.posed, images, {arguments.quality, arguments.fit_exposure, arguments.downscale},
      [&](const EvaluatedView& view) {
        const std::string psnr = fmt::format("{:.2f} dB", view.score->psnr);
        if (rows.size() < kMaxRows) {
          rows.push_back({view.image->name + "  " + psnr, *view.truth, *view.rendering});
        }
        progress.Update(++done, psnr);
      });
  progress.Finish();
  if (evaluation.scores.empty()) {
    throw InputError("{}: none of the {} {} images could be read; the first: {}", arguments.run,
                     images.size(), arguments.split, evaluation.unreadable.front());
  }
  for (const std::string& reason : evaluation.unreadable) spdlog::warn("{}; skipped", reason);
  if (!evaluation.unreadable.empty()) {
    spdlog::warn("{} of {} images could not be read; the mean is over the others",
                 evaluation.unreadable.size(), images.size());
  }
  WriteImage(output / "contact_sheet.png", ContactSheet(rows));
  return evaluation;
}

// Those of the field, and of the Gaussians that began at it.
double TrainingSeconds(const OpenedRun& run, bool uses_splats, const fs::path& folder) {
  return run.training_seconds + (uses_splats ? OpenGaussians(folder)->Made().seconds : 0);
}

void RunEval(const EvalArguments& arguments) {
  UseThreads(arguments.threads);
  const OpenedRun run = OpenRun(arguments.run);
  const bool is_field = arguments.with == "auto" && (arguments.effects || arguments.quality != 1);
  const bool uses_splats = !is_field && UsesSplats(arguments.with, arguments.run);
  const std::shared_ptr<const SceneModel> model = ChosenModel(run, uses_splats, arguments.run);
  run.model->Renderer(arguments.quality);  // checks the quality before a folder is created
  if (arguments.effects && arguments.with == "splats") {
    throw InputError("--with splats: --effects measures trainings of the field; leave out one");
  }
  const fs::path output =
      arguments.output.empty() ? fs::path(arguments.run) / "eval" : fs::path(arguments.output);
  MakeOutputFolder(output);
  if (!arguments.truth.empty()) {
    EvaluateTruth(run, arguments, output);
    return;
  }
  if (arguments.effects) {
    EvaluateEffects(run, arguments, output);
    return;
  }
  const Evaluation evaluation = EvaluateViews(run, *model, arguments, output);
  nlohmann::json result = JsonFromEvaluation(evaluation);
  result.update(
      {{"split", arguments.split},
       {"downscale", arguments.downscale.value_or(run.model->GetModel().config.data.downscale)},
       {"quality", arguments.quality},
       {"exposure_fitted", evaluation.exposure_fitted},
       {"step", model->Step()},
       {"with", uses_splats ? "splats" : "field"},
       {"training_seconds", TrainingSeconds(run, uses_splats, arguments.run)},
       {"left_out", evaluation.unreadable.size()}});
  // File names may not be valid UTF-8.
  const std::string text = result.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
  WriteFileAtomically(output / "eval.json", text + "\n");
  if (arguments.json) {
    fmt::print("{}\n", text);
    return;
  }
  PrintEvaluation(evaluation);
  if (uses_splats) fmt::print("of the Gaussians; --with field evaluates the field\n");
  if (evaluation.exposure_fitted) {
    fmt::print("each view rendered at the exposure fitted to its photograph\n");
  }
  fmt::print("{}\n", (output / "contact_sheet.png").string());
}

}  // namespace

void AddEvalCommand(CLI::App& app) {
  auto* command = app.add_subcommand("eval", "PSNR and SSIM of a run on held-out photographs");
  const auto arguments = std::make_shared<EvalArguments>();
  command->add_option("run", arguments->run, "run folder")->required();
  command->add_option("-o,--output", arguments->output,
                      "folder for eval.json and contact_sheet.png [RUN/eval]");
  command->add_option("--split", arguments->split, "which images: test, validation, train")
      ->check(CLI::IsMember({"test", "validation", "train"}))
      ->capture_default_str();
  AddModelChoice(*command, arguments->with);
  command
      ->add_option("--quality", arguments->quality,
                   "0 (fast) to 1 (exact); costs and errors are in docs/rendering.md")
      ->capture_default_str();
  command->add_flag("--fit-exposure", arguments->fit_exposure,
                    "render each view at the exposure fitted to its photograph; always on for runs "
                    "that simulate exposures, to compare others with them");
  command->add_option("--downscale", arguments->downscale,
                      "reduce photographs by this factor [that of the training]");
  command->add_flag("--effects", arguments->effects,
                    "instead: measure gain and cost of each simulated effect by short trainings");
  command->add_option("--effects-steps", arguments->effects_steps, "steps of each short training")
      ->check(CLI::Range(10, 1000000))
      ->capture_default_str();
  auto* truth = command->add_option("--truth", arguments->truth,
                                    "instead: compare materials and relit views with the truth in "
                                    "this folder (docs/relighting.md)");
  command->add_option("--maps", arguments->maps, "folder of the maps of its lights")->needs(truth);
  command->add_option("--bounces", arguments->bounces, "of relit views")
      ->check(CLI::Range(0, 100))
      ->capture_default_str()
      ->needs(truth);
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->add_flag("--json", arguments->json, "print JSON instead of the table");
  command->footer(
      "PSNR and SSIM are of images as they would be saved (8-bit sRGB).\n"
      "Examples:\n"
      "  nerf eval runs/fox\n"
      "  nerf eval runs/fox --with splats\n"
      "  nerf eval runs/fox --effects\n"
      "  nerf eval runs/totem --truth data/totem\n"
      "  nerf eval runs/fox --split train --json");
  command->callback([arguments] { RunEval(*arguments); });
}

}  // namespace nerf
