#include "nerf/pipeline/prepared_scene.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <map>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/stopwatch.h"
#include "nerf/effects/depth_supervision.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/found_points.h"
#include "nerf/pipeline/training_resolution.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/splits.h"
#include "sfm/colmap_model.h"
#include "sfm/colmap_text_writer.h"
#include "sfm/film.h"
#include "sfm/masks.h"
#include "sfm/pose_input.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

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

// Takes frames out of a film, into a folder.
void ReadFilm(const fs::path& film, const fs::path& frames, const DataOptions& options,
              const PipelineListener& listener) {
  MakeOutputFolder(frames.parent_path());
  listener(FilmRead{film, frames, sfm::ExtractFrames(film, frames, options.film_frames)});
}

PosedImages FindPoses(sfm::InputLocation location, const fs::path& folder,
                      const DataOptions& options, const PipelineListener& listener) {
  PosedImages posed;
  sfm::ColmapOptions colmap;
  colmap.threads = NumThreads();
  if (location.kind == sfm::InputKind::kFilm) {
    ReadFilm(location.images, FramesPath(folder), options, listener);
    location = {sfm::InputKind::kPhotos, {}, FramesPath(folder)};
    colmap.matcher = "sequential";
  }
  if (location.kind == sfm::InputKind::kPhotos) {
    PosesFound found;
    posed = sfm::PosesFromPhotos(location.images, ColmapPath(folder), colmap, &found.report);
    if (!found.report.skipped.empty()) {
      listener(Warning{fmt::format("{} of {} photographs cannot be read and are skipped",
                                   found.report.skipped.size(),
                                   found.report.skipped.size() + found.report.photos)});
    }
    listener(found);
  } else {
    posed = sfm::ReadPosedInput(location);
  }
  sfm::FindMasks(posed);
  return posed;
}

}  // namespace

std::vector<double> PreparedScene::StopsOf(const std::vector<View>& train) const {
  std::map<std::string, double> stops_of;
  for (std::size_t i = 0; i < inspection.stops.size(); ++i) {
    stops_of[posed.images[i].name] = inspection.stops[i];
  }
  std::vector<double> stops;
  for (const View& view : train) {
    if (const auto found = stops_of.find(view.name); found != stops_of.end()) {
      stops.push_back(found->second);
    }
  }
  return stops.size() == train.size() ? stops : std::vector<double>();
}

PreparedScene PrepareScene(const fs::path& input, const fs::path& folder,
                           const DataOptions& options, const PipelineListener& listener) {
  PreparedScene scene;
  const sfm::InputLocation location = sfm::FindInput(input);
  scene.from_photographs =
      location.kind == sfm::InputKind::kPhotos || location.kind == sfm::InputKind::kFilm;
  scene.posed = FindPoses(location, folder, options, listener);
  ReportMissing(scene.posed, listener);
  AssignSplits(scene.posed, options);
  scene.normalized_from_world = NormalizeScene(scene.posed);
  return scene;
}

double PointSeconds(const Config& config) {
  const double share = config.data.points_share;
  if (share == 0 || config.train.time_budget > 0) return share * config.train.time_budget;
  return TrainingSeconds(config.train);
}

void AddMissingPoints(PreparedScene& scene, const fs::path& folder, double most_seconds,
                      const PipelineListener& listener) {
  if (scene.from_photographs || !scene.posed.points.empty()) return;
  FindMissingPoints(scene.posed, PointsPath(folder), most_seconds, listener);
  scene.normalized_from_world = NormalizeScene(scene.posed);
}

void InspectScene(const Config& config, const std::set<std::string>& requested,
                  PreparedScene& scene, const PipelineListener& listener) {
  const Stopwatch watch;
  const auto photographs = static_cast<std::int64_t>(scene.posed.images.size());
  const bool may_learn_background =
      !requested.contains(kBackgroundEffect.name) || config.effects.background;
  scene.inspection = Inspect(
      scene.posed,
      [&](int read) {
        listener(InspectionProgress{read, photographs});
      },
      may_learn_background);
  scene.normalized_from_world = scene.inspection.normalized_from_world;
  scene.inspection_seconds = watch.Seconds();
  listener(InspectionProgress{photographs, photographs});
  if (!scene.inspection.warning.empty()) listener(Warning{scene.inspection.warning});
}

void ReportDataPlan(const PosedImages& posed, const DataOptions& options, int threads,
                    const PipelineListener& listener) {
  DataPlanned planned{PlanData(posed, options), 0, 0, threads};
  for (const auto& image : posed.images) {
    const Camera camera = Downscaled(posed.cameras[image.camera], options.downscale);
    planned.width = std::max(planned.width, camera.width);
    planned.height = std::max(planned.height, camera.height);
  }
  listener(planned);
}

void ReportMissing(const PosedImages& posed, const PipelineListener& listener) {
  for (const std::string& warning : posed.warnings) listener(Warning{warning});
  if (posed.missing.empty()) return;
  listener(Warning{fmt::format("{}: {} of {} images are missing and are skipped: {}",
                               posed.source.string(), posed.missing.size(),
                               posed.missing.size() + posed.images.size(), SomeOf(posed.missing))});
}

void SaveSparsePoints(const PosedImages& posed, const Config& config, const fs::path& run) {
  if (!config.effects.depth_supervision) return;
  if (posed.points.empty()) {
    throw InputError(
        "{}: effects.depth_supervision needs sparse points, and the input has none; use a COLMAP "
        "project or photographs, or turn the effect off",
        posed.source.string());
  }
  MakeOutputFolder(SparsePath(run));
  sfm::WriteColmapText(posed, SparsePath(run));
}

void AddSavedSparsePoints(const PosedImages& posed, const SceneNormalization& normalized_from_world,
                          const fs::path& run, Dataset& data) {
  const PosedImages sparse = sfm::ReadColmapModel(SparsePath(run), RootOf(posed.images.front()));
  AddSparseDepths(sparse, normalized_from_world, data);
}

Dataset LoadPhotographs(const PosedImages& posed, const Config& config,
                        const SceneNormalization& normalized_from_world, const fs::path& run,
                        const PipelineListener& listener) {
  if (config.effects.masks &&
      std::ranges::all_of(posed.images, [](const auto& image) { return image.mask.empty(); })) {
    throw InputError(
        "effects.masks: no photograph has a mask; put masks named IMAGE.png in a folder masks "
        "beside the photographs, or turn the effect off");
  }
  Dataset data =
      LoadDataset(posed, config.data, MeaningOf(config.effects.masks), normalized_from_world);
  if (!data.skipped.empty()) {
    for (const std::string& reason : data.skipped) listener(Warning{reason});
    listener(
        Warning{fmt::format("{} images could not be read and are skipped", data.skipped.size())});
  }
  if (data.linearized_photographs > 0) {
    listener(Warning{fmt::format(
        "{} of the photographs are display-referred (JPEG, PNG) among linear ones (EXR, HDR); they "
        "are converted to linear radiance, and their clipped pixels are ignored",
        data.linearized_photographs)});
  }
  if (config.effects.depth_supervision) {
    AddSavedSparsePoints(posed, normalized_from_world, run, data);
  }
  return data;
}

}  // namespace nerf
