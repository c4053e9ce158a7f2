#include "nerf/model/refined_poses.h"

#include <algorithm>
#include <cmath>

#include "nerf/field/pose_refinement.h"
#include "nerf/scene/camera_intrinsics.h"

namespace nerf {

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
  const torch::Tensor factors = model.pose_refinement->LogFocals().detach().exp();
  for (std::size_t k = 0; k < posed.cameras.size(); ++k) {
    const auto lens = static_cast<std::int64_t>(k);
    if (lens >= factors.size(0)) break;  // only held-out photographs use it
    Camera& camera = posed.cameras[k];
    const int focals = FirstDistortionParam(camera.model) - 2;  // two are the principal point
    for (int i = 0; i < focals; ++i) camera.params[i] *= factors[lens].item<double>();
  }
  return posed;
}

}  // namespace nerf
