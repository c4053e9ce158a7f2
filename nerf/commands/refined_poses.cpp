#include "nerf/commands/refined_poses.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "nerf/effects/poses.h"
#include "nerf/train/run_folder.h"
#include "sfm/camera_intrinsics.h"
#include "sfm/transforms_json.h"

namespace nerf {

void ReportRefinedPoses(const Model& model, const sfm::PosedImages& posed,
                        const std::filesystem::path& run) {
  if (!model.poses) return;
  const auto& normalized_from_world = model.scene.normalized_from_world;
  const PosesChange change = ChangeOf(*model.poses);
  const auto in_world = [&](double length) {
    return normalized_from_world.LengthWorldFromNormalized(length);
  };
  fmt::print(
      "poses: cameras turned by {:.3f} degrees in the median ({:.3f} at most) and shifted by "
      "{:.3g} "
      "units ({:.3g}); focal lengths changed by {:.2f} % at most\n",
      change.median_degrees, change.most_degrees, in_world(change.median_shift),
      in_world(change.most_shift), 100 * change.most_focal);

  sfm::PosedImages refined = posed;
  const std::vector<std::string>& names = model.scene.photographs;
  for (sfm::PosedImage& image : refined.images) {
    const auto found = std::ranges::find(names, image.name);
    if (found == names.end()) continue;  // held out: as it was
    image.world_from_camera = normalized_from_world.WorldFromCamera(
        model.poses->Refined(found - names.begin(),
                             normalized_from_world.NormalizedFromCamera(image.world_from_camera)));
  }
  const torch::Tensor factors = model.poses->LogFocals().detach().exp();
  for (std::size_t k = 0; k < refined.cameras.size(); ++k) {
    const auto lens = static_cast<std::int64_t>(k);
    if (lens >= factors.size(0)) break;  // of photographs that are held out
    sfm::Camera& camera = refined.cameras[k];
    const int focals = sfm::FirstDistortionParam(camera.model) - 2;  // the principal point's two
    for (int i = 0; i < focals; ++i) camera.params[i] *= factors[lens].item<double>();
  }
  sfm::WriteTransformsJson(refined, RefinedPosesPath(run));
}

}  // namespace nerf
