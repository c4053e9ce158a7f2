#include "nerf/effects/pose_refinement.h"

#include <spdlog/fmt/fmt.h>

#include <vector>

#include "nerf/base/quantile.h"
#include "nerf/inspect/evidence.h"
#include "nerf/inspect/verdict.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

constexpr double kWrongPixels = 1.25;  // threshold: median reprojection error, pixels

}  // namespace

Verdict JudgePoseRefinement(const PosedImages& posed) {
  std::vector<double> pixels;
  for (const SparsePoint& point : posed.points) {
    for (const TrackElement& seen : point.track) {
      const PosedImage& image = posed.images[seen.image];
      const auto pixel = PixelFromPoint(posed.cameras[image.camera],
                                        image.world_from_camera.inverse() * point.x_in_world);
      if (pixel) pixels.push_back((*pixel - seen.pixel).norm());
    }
  }
  if (pixels.empty()) return Undecided(kPoseRefinementEffect.name, "no tracks of sparse points");
  const double median = Quantile(pixels, 0.5);
  return Measured(kPoseRefinementEffect.name, median, kWrongPixels,
                  fmt::format("the median reprojection error of points is {:.2f} pixels (threshold "
                              "{:.2f})",
                              median, kWrongPixels));
}

const EffectDescriptor kPoseRefinementEffect = {
    .name = "pose_refinement",
    .old_name = "poses",
    .help = "poses and focal lengths that are a little wrong, refined with the field",
    .stage = "camera",
    .parameters = "poses.",
    .judge =
        [](const CaptureEvidence& e) {
          return e.HasTracks() ? JudgePoseRefinement(*e.posed)
                               : Undecided(kPoseRefinementEffect.name, e.unknown_because);
        },
    .trial_steps = 400,  // poses have to converge before quality improves
    .measured_on_halves = true,
};

}  // namespace nerf
