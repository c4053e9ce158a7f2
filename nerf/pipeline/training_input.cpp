#include "nerf/pipeline/training_input.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/progress.h"
#include "nerf/effects/depth.h"
#include "nerf/model/run_folder.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/data_plan.h"
#include "sfm/colmap_model.h"
#include "sfm/colmap_runner.h"
#include "sfm/colmap_text_writer.h"
#include "sfm/masks.h"
#include "sfm/pose_input.h"

namespace nerf {

namespace fs = std::filesystem;

namespace {

// "a, b, c and 14 more"
std::string SomeOf(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, names.size()); ++i) {
    text += (i > 0 ? ", " : "") + names[i];
  }
  if (names.size() > kShown) text += fmt::format(" and {} more", names.size() - kShown);
  return text;
}

// The folder in which an image's name is its path.
fs::path ImageFolder(const PosedImage& image) {
  fs::path folder = image.path;
  for ([[maybe_unused]] const fs::path& part : fs::path(image.name)) folder = folder.parent_path();
  return folder;
}

}  // namespace

PosedImages FindPoses(const fs::path& input, const fs::path& run, int threads) {
  const sfm::InputLocation location = sfm::FindInput(input);
  if (location.kind != sfm::InputKind::kPhotos) {
    PosedImages posed = sfm::ReadPosedInput(location);
    sfm::FindMasks(posed);
    return posed;
  }
  sfm::ColmapOptions colmap;
  colmap.threads = threads;
  sfm::ColmapReport report;
  PosedImages posed = sfm::PosesFromPhotos(location.images, ColmapPath(run), colmap, &report);
  if (!report.skipped.empty()) {
    spdlog::warn("{} of {} photographs cannot be read and are left out", report.skipped.size(),
                 report.skipped.size() + report.photos);
  }
  double seconds = 0;
  for (const auto& [step, step_seconds] : report.seconds) seconds += step_seconds;
  fmt::print(
      "poses: {} of {} photographs registered, {} points, reprojection error {:.2f} px, {}\n",
      report.registered, report.photos, report.points, report.mean_reprojection_error,
      FormatDuration(seconds));
  sfm::FindMasks(posed);
  return posed;
}

void PrintDataPlan(const PosedImages& posed, const DataOptions& options, int threads) {
  const DataPlan plan = PlanData(posed, options);
  int width = 0, height = 0;
  for (const auto& image : posed.images) {
    const Camera camera = Downscaled(posed.cameras[image.camera], options.downscale);
    width = std::max(width, camera.width);
    height = std::max(height, camera.height);
  }
  const std::string share =
      plan.stored_pixels == plan.pixels
          ? ""
          : fmt::format(", of every {:.3g} pixels one at random (data.memory_mb allows no more)",
                        static_cast<double>(plan.pixels) / static_cast<double>(plan.stored_pixels));
  fmt::print(
      "{} threads; {} images to train on, {} to validate, {} held out; {}x{} pixels; {} MB of "
      "pixels held{}\n",
      threads, plan.train, plan.validation, plan.held_out, width, height, plan.Bytes() >> 20,
      share);
  std::fflush(stdout);
}

void WarnOfMissing(const PosedImages& posed) {
  if (posed.missing.empty()) return;
  spdlog::warn("{}: {} of {} images are missing and left out: {}", posed.source.string(),
               posed.missing.size(), posed.missing.size() + posed.images.size(),
               SomeOf(posed.missing));
}

void KeepSparsePoints(const PosedImages& found, const Config& config, const fs::path& run) {
  if (!config.effects.depth) return;
  if (found.points.empty()) {
    throw InputError(
        "{}: effects.depth learns from sparse points, and there are none; give a COLMAP project or "
        "photographs, or leave the effect away",
        found.source.string());
  }
  MakeOutputFolder(SparsePath(run));
  sfm::WriteColmapText(found, SparsePath(run));
}

void AddKeptPoints(const PosedImages& posed, const SceneNormalization& normalized_from_world,
                   const fs::path& run, Dataset& data) {
  const PosedImages sparse =
      sfm::ReadColmapModel(SparsePath(run), ImageFolder(posed.images.front()));
  AddSeenPoints(sparse, normalized_from_world, data);
}

Dataset LoadOrWarn(const PosedImages& posed, const Config& config,
                   const SceneNormalization& normalized_from_world, const fs::path& run) {
  if (config.effects.masks &&
      std::ranges::all_of(posed.images, [](const auto& image) { return image.mask.empty(); })) {
    throw InputError(
        "effects.masks: no photograph has a mask; put them into a folder masks beside the "
        "photographs, IMAGE.png each, or leave the effect away");
  }
  Dataset data =
      LoadDataset(posed, config.data, MeaningOf(config.effects.masks), normalized_from_world);
  if (!data.skipped.empty()) {
    for (const std::string& reason : data.skipped) spdlog::warn("{}", reason);
    spdlog::warn("{} images could not be read and are left out", data.skipped.size());
  }
  if (data.linearized_photographs > 0) {
    spdlog::warn(
        "{} of the photographs are display-referred (JPEG, PNG) among linear ones (EXR, HDR); they "
        "are made linear, and say nothing where they are white",
        data.linearized_photographs);
  }
  if (config.effects.depth) AddKeptPoints(posed, normalized_from_world, run, data);
  return data;
}

}  // namespace nerf
