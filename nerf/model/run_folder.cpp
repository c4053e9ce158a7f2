#include "nerf/model/run_folder.h"

#include "nerf/base/input_error.h"
#include "nerf/model/checkpoint.h"
#include "nerf/model/refined_poses.h"
#include "sfm/transforms_json.h"

namespace nerf {

namespace fs = std::filesystem;

fs::path CheckpointPath(const fs::path& run) { return run / "checkpoint.nerf"; }
fs::path PosesPath(const fs::path& run) { return run / "transforms.json"; }
fs::path RefinedPosesPath(const fs::path& run) { return run / "refined_transforms.json"; }
fs::path ConfigPath(const fs::path& run) { return run / "config.json"; }
fs::path PicturePath(const fs::path& run) { return run / "picture.png"; }
fs::path MetricsPath(const fs::path& run) { return run / "metrics.jsonl"; }
fs::path FramesPath(const fs::path& run) { return run / "frames"; }
fs::path ColmapPath(const fs::path& run) { return run / "colmap"; }
fs::path PointsPath(const fs::path& run) { return run / "points"; }
fs::path SparsePath(const fs::path& run) { return run / "sparse"; }
fs::path GaussiansPath(const fs::path& run) { return run / "splats.nerf"; }
fs::path RepresentationPath(const fs::path& run) { return run / "representation.json"; }
fs::path MaterialsPath(const fs::path& run) { return run / "materials.nerf"; }
fs::path EnvironmentPath(const fs::path& run, const std::string& light) {
  return run / (light.empty() ? "environment.exr" : "environment_" + light + ".exr");
}
fs::path LightsPath(const fs::path& run) { return run / "lights.json"; }

std::shared_ptr<const GaussianModel> OpenGaussians(const fs::path& run) {
  if (!fs::exists(GaussiansPath(run))) {
    throw InputError("{}: contains no splats.nerf; make Gaussians first: nerf splat {}",
                     run.string(), run.string());
  }
  return std::make_shared<const GaussianModel>(ReadGaussians(GaussiansPath(run)));
}

Checkpoint ReadRunCheckpoint(const fs::path& run) {
  if (!fs::exists(CheckpointPath(run))) {
    throw InputError("{}: contains no checkpoint.nerf; train first: nerf train INPUT -o {}",
                     run.string(), run.string());
  }
  return ReadCheckpoint(CheckpointPath(run));
}

OpenedRun OpenRun(const fs::path& run) {
  const Checkpoint checkpoint = ReadRunCheckpoint(run);
  OpenedRun opened;
  opened.model = std::make_shared<const ModelSnapshot>(
      ModelFromCheckpoint(checkpoint), checkpoint.meta.value("step", std::int64_t{0}));
  opened.posed = RefinedPoses(opened.model->GetModel(),
                              sfm::ReadTransformsJson(PosesPath(run), sfm::AbsentImages::kKeep));
  opened.training_seconds = checkpoint.meta.value("training_seconds", 0.0);
  return opened;
}

}  // namespace nerf
