#include "nerf/model/refined_poses.h"

#include <algorithm>
#include <cmath>

#include "nerf/field/pose_refinement.h"
#include "nerf/scene/camera_intrinsics.h"

namespace nerf {
namespace {

void RefineFocal(const Model& model, std::int64_t lens, Camera& camera) {
  const torch::Tensor factors = model.pose_refinement->LogFocals().detach().exp();
  if (lens >= factors.size(0)) return;                        // only held-out ones use it
  const int focals = FirstDistortionParam(camera.model) - 2;  // two are the principal point
  for (int i = 0; i < focals; ++i) camera.params[i] *= factors[lens].item<double>();
}

}  // namespace

PosedImages RefinedPoses(const Model& model, PosedImages posed) {
  if (!model.pose_refinement) return posed;
  const auto& normalized_from_world = model.scene.normalized_from_world;
  const std::vector<std::string>& names = model.scene.photographs;
  for (PosedImage& image : posed.images) {
    const auto found = std::ranges::find(names, image.name);
    if (found == names.end()) continue;  // held out: no refined pose
    image.world_from_camera = normalized_from_world.WorldFromCamera(model.pose_refinement->Refined(
        found - names.begin(),
        normalized_from_world.NormalizedFromCamera(image.world_from_camera)));
  }
  for (std::size_t k = 0; k < posed.cameras.size(); ++k) {
    RefineFocal(model, static_cast<std::int64_t>(k), posed.cameras[k]);
  }
  return posed;
}

void RefineView(const Model& model, const std::string& name, std::int64_t lens,
                Eigen::Isometry3d& normalized_from_camera, Camera& camera) {
  if (!model.pose_refinement) return;
  const std::vector<std::string>& names = model.scene.photographs;
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) {
    normalized_from_camera =
        model.pose_refinement->Refined(found - names.begin(), normalized_from_camera);
  }
  RefineFocal(model, lens, camera);
}

}  // namespace nerf
