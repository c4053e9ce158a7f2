#include "nerf/commands/shots.h"

#include <algorithm>
#include <filesystem>

#include "nerf/base/input_error.h"
#include "nerf/output/camera_path.h"
#include "nerf/output/camera_path_json.h"
#include "nerf/output/video.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

// "train/r_0.png" -> "train_r_0", "../images/0001.jpg" -> "images_0001"
std::string FileStem(const std::string& image_name) {
  std::string stem;
  for (const fs::path& part : fs::path(image_name).replace_extension().relative_path()) {
    if (part == "..") continue;
    if (!stem.empty()) stem += '_';
    stem += part.string();
  }
  return stem;
}

Shot ShotOf(const OpenedRun& run, const PosedImage& image, int downscale) {
  return {FileStem(image.name), image.world_from_camera,
          Downscaled(run.posed.cameras[image.camera], downscale)};
}

ShotList ShotsOfPath(const CameraPath& path, const std::string& folder, int downscale) {
  ShotList list{{}, folder, path.frames_per_second};
  for (const PathPose& pose : path.poses) {
    list.shots.push_back({fs::path(FrameName(static_cast<int>(list.shots.size()))).stem().string(),
                          pose.world_from_camera, Downscaled(pose.camera, downscale)});
  }
  return list;
}

}  // namespace

ShotList ChooseShots(const OpenedRun& run, const ShotOptions& options, const fs::path& folder) {
  const int trained = run.model->GetModel().config.data.downscale;
  const int downscale = options.downscale.value_or(trained);
  if (!options.image.empty()) {
    const auto found = std::ranges::find_if(run.posed.images, [&](const auto& image) {
      return image.name == options.image || FileStem(image.name) == options.image;
    });
    if (found == run.posed.images.end()) {
      throw InputError("--image {}: the run has no such photograph; names are listed in {}",
                       options.image, PosesPath(folder).string());
    }
    return {{ShotOf(run, *found, downscale)}, "image", {}};
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
  for (const PosedImage& image : run.posed.images) {
    if (image.split == Split::kTest) list.shots.push_back(ShotOf(run, image, downscale));
  }
  if (list.shots.empty()) {
    throw InputError("{}: the run has no held-out images; use --path, --pose or --image",
                     folder.string());
  }
  return list;
}

}  // namespace nerf
