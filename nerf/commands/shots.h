#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nerf/model/run_folder.h"
#include "nerf/output/camera_path.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// Which views to render. Without image, pose and path: those of the held-out photographs.
struct ShotOptions {
  std::string image;  // name of a photograph
  std::string pose;   // JSON file
  std::string path;   // orbit, spiral, training, or JSON file
  int frames = 120;
  std::optional<int> downscale;
};

// One view to render, in the frame and units of the input.
struct Shot {
  std::string name;
  Eigen::Isometry3d world_from_camera;
  Camera camera;
};

struct ShotList {
  std::vector<Shot> shots;
  std::string folder;                       // below RUN/renders
  std::optional<double> frames_per_second;  // of a film
};

// The poses of a path.
//   folder  below RUN/renders
ShotList ShotsOfPath(const CameraPath& path, const std::string& folder, int downscale);

// The views to render.
//   folder  of the run, for errors
// Throws InputError if there is no such view.
ShotList ChooseShots(const OpenedRun& run, const ShotOptions& options,
                     const std::filesystem::path& folder);

}  // namespace nerf
