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

#include "nerf/commands/commands.h"
#include "nerf/commands/effects_worth.h"
#include "nerf/commands/threads.h"
#include "nerf/data/camera.h"
#include "nerf/data/dataset.h"
#include "nerf/data/image_io.h"
#include "nerf/data/image_metrics.h"
#include "nerf/effects/exposure_fit.h"
#include "nerf/output/contact_sheet.h"
#include "nerf/peak_memory.h"
#include "nerf/render/image_renderer.h"
#include "nerf/stopwatch.h"
#include "nerf/train/run_folder.h"
#include "nerf/train/view_renderer.h"
#include "sfm/atomic_file.h"
#include "sfm/input_error.h"
#include "sfm/progress.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

struct EvalArguments {
  std::string run;
  std::string output;
  std::string split = "test";
  double quality = 1;
  bool effects = false;
  int effects_steps = 500;
  int threads = 0;
  bool json = false;
};

struct Score {
  std::string name;
  double psnr = 0, ssim = 0, seconds = 0;
};

// What the views took, all together.
struct Cost {
  std::int64_t views = 0, pixels = 0, samples = 0;
  StageSeconds seconds;
  double reading = 0;  // seconds, of photographs

  void Add(const RenderedView& view) {
    ++views;
    pixels += static_cast<std::int64_t>(view.rgb.width) * view.rgb.height;
    samples += view.samples;
    seconds.Add(view.seconds);
  }
  double SamplesPerRay() const {
    return static_cast<double>(samples) / static_cast<double>(pixels);
  }
  double PerView(double seconds_of_all) const {
    return seconds_of_all / static_cast<double>(views);
  }
};

// Of the contact sheet: whoever looks at pictures looks at no more, and memory stays bounded.
constexpr std::size_t kMostRows = 50;

sfm::Split SplitFromName(const std::string& name) {
  if (name == "train") return sfm::Split::kTrain;
  return name == "validation" ? sfm::Split::kValidation : sfm::Split::kTest;
}

// JSON has no infinity; equal images are said in words.
nlohmann::json JsonNumber(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json("inf");
}

Score MeanOf(const std::vector<Score>& scores) {
  Score mean{"mean", 0, 0, 0};
  for (const Score& s : scores) {
    mean.psnr += s.psnr;
    mean.ssim += s.ssim;
    mean.seconds += s.seconds;
  }
  const auto count = static_cast<double>(scores.size());
  return {mean.name, mean.psnr / count, mean.ssim / count, mean.seconds / count};
}

// Nobody knows the exposure of a photograph that training never saw: it is fitted, one gain a
// channel.
void FitExposure(const Image& truth, Image& rendered) {
  const Image shown = rendered.encoding == ColorEncoding::kLinear ? ToLinear(truth) : truth;
  ApplyGains(FitGains(rendered.pixels, shown.pixels, rendered.encoding), rendered.pixels);
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

nlohmann::json JsonFromScores(const OpenedRun& run, const EvalArguments& arguments,
                              const std::vector<Score>& scores, const Cost& cost,
                              std::size_t left_out) {
  const Score mean = MeanOf(scores);
  nlohmann::json images = nlohmann::json::array();
  for (const Score& s : scores) {
    images.push_back(
        {{"name", s.name}, {"psnr", JsonNumber(s.psnr)}, {"ssim", s.ssim}, {"seconds", s.seconds}});
  }
  return {{"split", arguments.split},
          {"downscale", run.model.config.data.downscale},
          {"quality", arguments.quality},
          {"exposure_fitted", run.model.exposure != nullptr},
          {"step", run.step},
          {"training_seconds", run.training_seconds},
          {"psnr", JsonNumber(mean.psnr)},
          {"ssim", mean.ssim},
          {"seconds_per_frame", mean.seconds},
          {"stage_seconds_per_frame",
           {{"sampling", cost.PerView(cost.seconds.sampling)},
            {"encoding", cost.PerView(cost.seconds.encoding)},
            {"networks", cost.PerView(cost.seconds.networks)},
            {"compositing", cost.PerView(cost.seconds.compositing)},
            {"reading_photographs", cost.PerView(cost.reading)}}},
          {"samples_per_ray", cost.SamplesPerRay()},
          {"peak_megabytes", PeakMegabytes()},
          {"left_out", left_out},
          {"images", images}};
}

void PrintTable(const std::vector<Score>& scores, const Cost& cost) {
  std::size_t width = 5;
  for (const Score& s : scores) width = std::max(width, s.name.size());
  fmt::print("{:<{}}  {:>8}  {:>7}  {:>9}\n", "image", width, "PSNR dB", "SSIM", "seconds");
  const auto row = [width](const Score& s) {
    fmt::print("{:<{}}  {:>8.2f}  {:>7.4f}  {:>9.2f}\n", s.name, width, s.psnr, s.ssim, s.seconds);
  };
  for (const Score& s : scores) row(s);
  row(MeanOf(scores));
  fmt::print("{:.1f} samples a ray, {:.0f} MB at most\n", cost.SamplesPerRay(), PeakMegabytes());
  if (cost.seconds.Sum() == 0) return;  // of a renderer that does not tell
  fmt::print("of a frame: sampling {:.2f} s, encoding {:.2f} s, networks {:.2f} s, rest {:.2f} s\n",
             cost.PerView(cost.seconds.sampling), cost.PerView(cost.seconds.encoding),
             cost.PerView(cost.seconds.networks), cost.PerView(cost.seconds.compositing));
}

void RunEval(const EvalArguments& arguments) {
  UseThreads(arguments.threads);
  const OpenedRun run = OpenRun(arguments.run);
  const std::shared_ptr<RayRenderer> renderer = ViewRenderer(run.model, arguments.quality);
  const fs::path output =
      arguments.output.empty() ? fs::path(arguments.run) / "eval" : fs::path(arguments.output);
  sfm::MakeOutputFolder(output);
  if (arguments.effects) {
    MeasureEffects(run, arguments.effects_steps, arguments.json, output);
    return;
  }

  std::vector<const sfm::PosedImage*> images;
  for (const auto& image : run.posed.images) {
    if (image.split == SplitFromName(arguments.split)) images.push_back(&image);
  }
  if (images.empty()) {
    throw sfm::InputError("{}: the run has no {} images; choose another --split", arguments.run,
                          arguments.split);
  }

  const SceneFacts& scene = run.model.scene;
  const int downscale = run.model.config.data.downscale;
  sfm::ProgressLine progress("evaluating", static_cast<std::int64_t>(images.size()));
  std::vector<Score> scores;
  std::vector<ContactSheetRow> rows;
  Cost cost;
  for (const sfm::PosedImage* image : images) {
    Image truth;
    std::vector<std::uint32_t> whole;
    LapTimer reading;
    try {
      Photograph photograph =
          LoadPhotograph(run.posed, *image, {downscale, run.model.config.effects.masks});
      truth = OnWhite(photograph.pixels);
      whole = std::move(photograph.whole);
    } catch (const sfm::InputError& error) {
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
    if (run.model.exposure) FitExposure(truth, view.rgb);
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
    throw sfm::InputError("{}: none of the {} images could be read", arguments.run,
                          arguments.split);
  }

  const nlohmann::json result =
      JsonFromScores(run, arguments, scores, cost, images.size() - scores.size());
  // Names of files need not be UTF-8.
  const std::string text = result.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
  sfm::WriteFileAtomically(output / "eval.json", text + "\n");
  WriteImage(output / "contact_sheet.png", ContactSheet(rows));
  if (arguments.json) {
    fmt::print("{}\n", text);
  } else {
    PrintTable(scores, cost);
    if (run.model.exposure) fmt::print("each rendering at its photograph's exposure, fitted\n");
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
