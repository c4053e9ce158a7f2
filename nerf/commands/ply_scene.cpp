#include "nerf/commands/ply_scene.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/quantile.h"
#include "nerf/output/camera_path_json.h"
#include "nerf/scene/camera.h"
#include "nerf/splats/gaussian_ply.h"

namespace nerf {
namespace {

constexpr int kWidth = 800, kHeight = 600;
constexpr double kFov = 50 * std::numbers::pi / 180;  // vertical
// Means nearer to a camera are not drawn: so much of the median distance from the middle of all.
constexpr double kNear = 0.01;

double MedianDistance(const GaussianCloud& cloud) {
  std::vector<float> middle(3);
  for (int k = 0; k < 3; ++k) {
    std::vector<float> values;
    for (std::int64_t i = 0; i < cloud.count; ++i) {
      values.push_back(cloud.At(i, kernels::kMeanRow + k));
    }
    middle[k] = Quantile(values, 0.5);
  }
  std::vector<float> distances;
  for (std::int64_t i = 0; i < cloud.count; ++i) {
    const Eigen::Vector3f offset(cloud.At(i, kernels::kMeanRow) - middle[0],
                                 cloud.At(i, kernels::kMeanRow + 1) - middle[1],
                                 cloud.At(i, kernels::kMeanRow + 2) - middle[2]);
    distances.push_back(offset.norm());
  }
  return Quantile(distances, 0.5);
}

}  // namespace

std::shared_ptr<const GaussianModel> OpenPly(const std::filesystem::path& file) {
  GaussianPly read = ReadGaussianPly(file);
  if (read.left_out > 0) {
    spdlog::warn("{}: {} Gaussians with values that are not finite are left out", file.string(),
                 read.left_out);
  }
  const double near = std::clamp(kNear * MedianDistance(read.cloud), 1e-6, 1e3);
  return std::make_shared<const GaussianModel>(LoadConfig("base", {}), SceneFacts(),
                                               std::move(read.cloud), near, FitFacts());
}

ShotList ChoosePlyShots(const ShotOptions& options, const std::filesystem::path& file) {
  const std::filesystem::path path = options.path;
  if (!options.image.empty() || (options.pose.empty() && path.extension() != ".json")) {
    throw InputError(
        "{}: a PLY file has no cameras; give --pose FILE.json, or --path FILE.json with poses",
        file.string());
  }
  const int downscale = options.downscale.value_or(1);
  ShotList list;
  if (!options.pose.empty()) {
    PosedImages one;
    one.source = file;
    one.cameras = {PinholeFromFov(kWidth, kHeight, kFov)};
    one.images.resize(1);
    const PathPose pose = ReadPose(options.pose, one);
    list.shots.push_back({std::filesystem::path(options.pose).stem().string(),
                          pose.world_from_camera, Downscaled(pose.camera, downscale)});
    return list;
  }
  return ShotsOfPath(ReadCameraPath(options.path), path.stem().string(), downscale);
}

}  // namespace nerf
