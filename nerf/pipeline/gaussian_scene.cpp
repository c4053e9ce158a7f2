#include "nerf/pipeline/gaussian_scene.h"

#include <algorithm>

#include "nerf/base/input_error.h"
#include "nerf/model/refined_poses.h"
#include "nerf/pipeline/surface_points.h"

namespace nerf {
namespace {

// Gaussians that are nearer to a camera than this share of what it sees are not drawn: they would
// hang in front of it, to explain one photograph.
constexpr double kNearShare = 0.5;

std::vector<TargetView> RefinedViews(const Model& field, const std::vector<View>& views,
                                     bool has_gains) {
  std::vector<TargetView> targets = TargetViewsOf(views);
  for (TargetView& target : targets) {
    const View& view = *target.photograph;
    RefineView(field, view.name, view.lens, target.normalized_from_camera, target.camera);
    if (has_gains) target.gains = GainsOf(field, view.name);
  }
  return targets;
}

}  // namespace

GaussianScene GaussianSceneOf(const Model& field, const Dataset& data) {
  if (field.scene.encoding == ColorEncoding::kLinear) {
    throw InputError(
        "the photographs are linear, to which Gaussians are not fitted yet; use the field: "
        "--representation field, --with field");
  }
  GaussianScene scene;
  scene.config = field.config;
  if (!scene.config.effects.view_dependence) scene.config.splats.harmonics_order = 0;
  scene.facts = field.scene;
  scene.train = RefinedViews(field, data.train, field.exposure != nullptr);
  scene.validation = RefinedViews(field, data.validation, false);
  return scene;
}

std::optional<GaussianStart> StartAtSurfaces(const ModelSnapshot& field, const GaussianScene& scene,
                                             const std::atomic<bool>& stop,
                                             const std::function<void(std::size_t)>& progress) {
  const SplatOptions& options = scene.config.splats;
  const std::optional<SurfacePoints> surfaces =
      FindSurfacePoints(field, scene.train, options.count, stop, progress);
  if (!surfaces) return std::nullopt;
  if (surfaces->points.empty()) {
    throw InputError("the views of the field agree on no surface; train it longer");
  }
  FitFacts made;
  made.field_step = field.Step();
  return GaussianStart{
      BeginFit(GaussiansAtPoints(surfaces->points, options.count, options.harmonics_order,
                                 scene.config.train.seed)),
      std::max(scene.config.march.near_distance, kNearShare * surfaces->nearest), made};
}

}  // namespace nerf
