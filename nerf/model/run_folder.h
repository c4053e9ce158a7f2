#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "nerf/model/gaussian_model.h"
#include "nerf/model/snapshot.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// The files of a run folder.
//   checkpoint.nerf          the model and the state of training
//   transforms.json          poses in the input's frame and units, with the splits
//   config.json              the configuration, every key
//   metrics.jsonl            one line per validation
//   frames/                  the frames of a film
//   colmap/                  COLMAP's files, if poses were found from photographs
//   splats.nerf              Gaussians, if training or nerf splat made them
//   representation.json      which of the two is better, and how that was decided
//   materials.nerf           surface, materials and light, if they were found
//   environment.exr          that light; environment_NAME.exr, where there are several
//   lights.json              what is known of the lights, if nerf train was given it
//   points/                  the same, if sparse points were found for poses that were given
//   picture.png              a photograph and its rendering, at the end of training
//   refined_transforms.json  refined poses, with pose_refinement
//   sparse/                  the input's sparse points, a COLMAP model, with depth_supervision
std::filesystem::path CheckpointPath(const std::filesystem::path& run);
std::filesystem::path PosesPath(const std::filesystem::path& run);
std::filesystem::path RefinedPosesPath(const std::filesystem::path& run);
std::filesystem::path ConfigPath(const std::filesystem::path& run);
std::filesystem::path PicturePath(const std::filesystem::path& run);
std::filesystem::path MetricsPath(const std::filesystem::path& run);
std::filesystem::path FramesPath(const std::filesystem::path& run);
std::filesystem::path ColmapPath(const std::filesystem::path& run);
std::filesystem::path PointsPath(const std::filesystem::path& run);
std::filesystem::path SparsePath(const std::filesystem::path& run);
std::filesystem::path GaussiansPath(const std::filesystem::path& run);
std::filesystem::path RepresentationPath(const std::filesystem::path& run);
std::filesystem::path MaterialsPath(const std::filesystem::path& run);
//   light  name of one of several
std::filesystem::path EnvironmentPath(const std::filesystem::path& run,
                                      const std::string& light = "");
std::filesystem::path LightsPath(const std::filesystem::path& run);

// A trained run, for rendering and evaluation.
struct OpenedRun {
  std::shared_ptr<const ModelSnapshot> model;
  PosedImages posed;  // with refined poses, if the model has them
  double training_seconds = 0;
};

// The photographs are not read and may be missing; comparing with one is then an error.
// Throws InputError naming what is missing or damaged.
OpenedRun OpenRun(const std::filesystem::path& run);

// The Gaussians of a run. Throws InputError if it has none.
std::shared_ptr<const GaussianModel> OpenGaussians(const std::filesystem::path& run);

// The checkpoint of a run. Throws InputError if there is none.
Checkpoint ReadRunCheckpoint(const std::filesystem::path& run);

}  // namespace nerf
