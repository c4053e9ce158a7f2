#include "nerf/pipeline/pose_refinement_report.h"

#include <spdlog/fmt/fmt.h>

#include "nerf/field/poses.h"
#include "nerf/model/refined_poses.h"
#include "nerf/model/run_folder.h"
#include "sfm/transforms_json.h"

namespace nerf {

void ReportRefinedPoses(const Model& model, const PosedImages& posed,
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

  sfm::WriteTransformsJson(RefinedPoses(model, posed), RefinedPosesPath(run));
}

}  // namespace nerf
