#include "nerf/commands/shots.h"

#include <algorithm>
#include <filesystem>

#include "nerf/base/input_error.h"
#include "nerf/output/camera_path.h"
#include "nerf/output/camera_path_json.h"
#include "nerf/output/video.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/output_names.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

Shot ShotOf(const OpenedRun& run, std::size_t image, const std::string& name, int downscale) {
  const PosedImage& posed = run.posed.images[image];
  return {name, posed.world_from_camera, Downscaled(run.posed.cameras[posed.camera], downscale)};
}

}  // namespace

ShotList ShotsOfPath(const CameraPath& path, const std::string& folder, int downscale) {
  ShotList list{{}, folder, path.frames_per_second};
  for (const PathPose& pose : path.poses) {
    list.shots.push_back({fs::path(FrameName(static_cast<int>(list.shots.size()))).stem().string(),
                          pose.world_from_camera, Downscaled(pose.camera, downscale)});
  }
  return list;
}

ShotList ChooseShots(const OpenedRun& run, const ShotOptions& options, const fs::path& folder) {
  const int trained = run.model->GetModel().config.data.downscale;
  const int downscale = options.downscale.value_or(trained);
  const std::vector<PosedImage>& images = run.posed.images;
  const std::vector<std::string> names = OutputNames(images);
  if (!options.image.empty()) {
    std::size_t found = 0;
    while (found < images.size() && images[found].name != options.image) ++found;
    if (found == images.size()) {
      found = static_cast<std::size_t>(std::ranges::find(names, options.image) - names.begin());
    }
    if (found == images.size()) {
      throw InputError("--image {}: the run has no such photograph; names are listed in {}",
                       options.image, PosesPath(folder).string());
    }
    return {{ShotOf(run, found, names[found], downscale)}, "image", {}};
  }
  if (!options.pose.empty()) {
    const PathPose pose = ReadPose(options.pose, run.posed);
    return {{{fs::path(options.pose).stem().string(), pose.world_from_camera,
              Downscaled(pose.camera, options.downscale.value_or(1))}},
            "pose",
            {}};
  }
  const auto& normalized_from_world = run.model->Scene().normalized_from_world;
  if (options.path == "orbit") {
    return ShotsOfPath(OrbitPath(run.posed, normalized_from_world, options.frames), "orbit",
                       downscale);
  }
  if (options.path == "spiral") {
    return ShotsOfPath(SpiralPath(run.posed, normalized_from_world, options.frames), "spiral",
                       downscale);
  }
  if (options.path == "training") {
    return ShotsOfPath(TrainingPath(run.posed, options.frames), "training", downscale);
  }
  if (!options.path.empty()) {
    return ShotsOfPath(ReadCameraPath(options.path), fs::path(options.path).stem().string(),
                       options.downscale.value_or(1));
  }
  ShotList list{{}, "held-out", {}};
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (images[i].split == Split::kTest) list.shots.push_back(ShotOf(run, i, names[i], downscale));
  }
  if (list.shots.empty()) {
    throw InputError("{}: the run has no held-out images; use --path, --pose or --image",
                     folder.string());
  }
  return list;
}

}  // namespace nerf
