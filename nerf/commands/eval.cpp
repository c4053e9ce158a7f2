#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/progress.h"
#include "nerf/base/stopwatch.h"
#include "nerf/commands/commands.h"
#include "nerf/commands/eval_scores.h"
#include "nerf/commands/threads.h"
#include "nerf/effects/exposure_fit.h"
#include "nerf/image/image_io.h"
#include "nerf/image/image_metrics.h"
#include "nerf/model/run_folder.h"
#include "nerf/model/view_renderer.h"
#include "nerf/output/contact_sheet.h"
#include "nerf/pipeline/effects_worth.h"
#include "nerf/render/image_renderer.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/photograph.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

struct EvalArguments {
  std::string run;
  std::string output;
  std::string split = "test";
  double quality = 1;
  bool fit_exposure = false;
  bool effects = false;
  int effects_steps = 500;
  int threads = 0;
  bool json = false;
};

// Of the contact sheet: whoever looks at pictures looks at no more, and memory stays bounded.
constexpr std::size_t kMostRows = 50;

Split SplitFromName(const std::string& name) {
  if (name == "train") return Split::kTrain;
  return name == "validation" ? Split::kValidation : Split::kTest;
}

// Nobody knows the exposure of a photograph that training never saw: it is fitted, one gain a
// channel.
void FitExposure(const Image& truth, const Eigen::Vector3f& background, RenderedView& view) {
  const Image shown = view.rgb.encoding == ColorEncoding::kLinear ? ToLinear(truth) : truth;
  const std::vector<float> through = SeenThrough(view.opacity.pixels, {background.data(), 3});
  std::vector<float>& rgb = view.rgb.pixels;
  ApplyGains(FitGains(rgb, shown.pixels, through, view.rgb.encoding), through, rgb);
}

// Where a mask says to ignore what a photograph shows, the rendering counts as right.
//   whole    pixels that count; empty: all
//   returns  the decibels by which the PSNR of the whole picture is better than that of those
double Ignore(const std::vector<std::uint32_t>& whole, const Image& truth, Image& rendered) {
  if (whole.empty()) return 0;
  Image counted = rendered.encoding == ColorEncoding::kLinear ? ToLinear(truth) : truth;
  for (const std::uint32_t pixel : whole) {
    std::copy_n(&rendered.pixels[3 * pixel], 3, &counted.pixels[3 * pixel]);
  }
  rendered = std::move(counted);
  const double all = static_cast<double>(truth.width) * truth.height;
  return 10 * std::log10(all / static_cast<double>(whole.size()));
}

void RunEval(const EvalArguments& arguments) {
  UseThreads(arguments.threads);
  const OpenedRun run = OpenRun(arguments.run);
  const std::shared_ptr<RayRenderer> renderer = ViewRenderer(run.model, arguments.quality);
  const fs::path output =
      arguments.output.empty() ? fs::path(arguments.run) / "eval" : fs::path(arguments.output);
  MakeOutputFolder(output);
  if (arguments.effects) {
    MeasureEffects(run, arguments.effects_steps, arguments.json, output);
    return;
  }

  std::vector<const PosedImage*> images;
  for (const auto& image : run.posed.images) {
    if (image.split == SplitFromName(arguments.split)) images.push_back(&image);
  }
  if (images.empty()) {
    throw InputError("{}: the run has no {} images; choose another --split", arguments.run,
                     arguments.split);
  }

  const SceneFacts& scene = run.model.scene;
  const int downscale = run.model.config.data.downscale;
  const bool fit_exposure = arguments.fit_exposure || run.model.exposure;
  ProgressLine progress("evaluating", static_cast<std::int64_t>(images.size()));
  std::vector<Score> scores;
  std::vector<ContactSheetRow> rows;
  Cost cost;
  for (const PosedImage* image : images) {
    Image truth;
    std::vector<std::uint32_t> whole;
    LapTimer reading;
    try {
      Photograph photograph =
          LoadPhotograph(run.posed, *image, {downscale, MeaningOf(run.model.config.effects.masks)});
      truth = OnWhite(photograph.pixels);
      whole = std::move(photograph.valid_pixels);
    } catch (const InputError& error) {
      spdlog::warn("{}; left out", error.what());
      continue;
    }
    reading.Lap(cost.reading);
    const Stopwatch watch;
    RenderedView view =
        RenderView(*renderer, Downscaled(run.posed.cameras[image->camera], downscale),
                   scene.normalized_from_world.NormalizedFromCamera(image->world_from_camera),
                   DisplayBackground(scene.has_alpha), scene.encoding);
    const double seconds = watch.Seconds();
    cost.Add(view);
    if (fit_exposure) FitExposure(truth, DisplayBackground(scene.has_alpha), view);
    const double of_ignored = Ignore(whole, truth, view.rgb);
    const double psnr = Psnr(truth, view.rgb) - of_ignored;
    scores.push_back({image->name, psnr, Ssim(truth, view.rgb), seconds});
    if (rows.size() < kMostRows) {
      rows.push_back({fmt::format("{}  {:.2f} dB", image->name, psnr), truth, view.rgb});
    }
    progress.Update(static_cast<std::int64_t>(scores.size()), fmt::format("{:.2f} dB", psnr));
  }
  progress.Finish();
  if (scores.size() < images.size()) {
    spdlog::warn("{} of {} images could not be read; the mean is of the others",
                 images.size() - scores.size(), images.size());
  }
  if (scores.empty()) {
    throw InputError("{}: none of the {} images could be read", arguments.run, arguments.split);
  }

  nlohmann::json result = JsonFromScores(scores, cost);
  result.update({{"split", arguments.split},
                 {"downscale", downscale},
                 {"quality", arguments.quality},
                 {"exposure_fitted", fit_exposure},
                 {"step", run.step},
                 {"training_seconds", run.training_seconds},
                 {"left_out", images.size() - scores.size()}});
  // Names of files need not be UTF-8.
  const std::string text = result.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
  WriteFileAtomically(output / "eval.json", text + "\n");
  WriteImage(output / "contact_sheet.png", ContactSheet(rows));
  if (arguments.json) {
    fmt::print("{}\n", text);
  } else {
    PrintScores(scores, cost);
    if (fit_exposure) fmt::print("each rendering at its photograph's exposure, fitted\n");
    fmt::print("{}\n", (output / "contact_sheet.png").string());
  }
}

}  // namespace

void AddEvalCommand(CLI::App& app) {
  auto* command = app.add_subcommand("eval", "PSNR and SSIM of a run on photographs it never saw");
  const auto arguments = std::make_shared<EvalArguments>();
  command->add_option("run", arguments->run, "run folder")->required();
  command->add_option("-o,--output", arguments->output,
                      "where eval.json and contact_sheet.png go [RUN/eval]");
  command->add_option("--split", arguments->split, "which images: test, validation, train")
      ->check(CLI::IsMember({"test", "validation", "train"}))
      ->capture_default_str();
  command
      ->add_option("--quality", arguments->quality,
                   "0, fast, to 1, exact; what each costs stands in the README")
      ->capture_default_str();
  command->add_flag("--fit-exposure", arguments->fit_exposure,
                    "compare each rendering at its photograph's exposure, as runs that simulate "
                    "exposures always are, so that others can be compared with them");
  command->add_flag("--effects", arguments->effects,
                    "instead: what each simulated effect is worth and costs, by short trainings");
  command
      ->add_option("--effects-steps", arguments->effects_steps, "steps of each of those trainings")
      ->check(CLI::Range(10, 1000000))
      ->capture_default_str();
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->add_flag("--json", arguments->json, "print JSON instead of the table");
  command->footer(
      "PSNR and SSIM compare pictures as they would be saved (8-bit sRGB).\n"
      "Examples:\n"
      "  nerf eval runs/fox\n"
      "  nerf eval runs/fox --effects\n"
      "  nerf eval runs/fox --split train --json");
  command->callback([arguments] { RunEval(*arguments); });
}

}  // namespace nerf
