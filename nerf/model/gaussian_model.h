#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "nerf/model/checkpoint.h"
#include "nerf/model/scene_model.h"
#include "nerf/scene/lens_coverage.h"
#include "nerf/splats/gaussian_cloud.h"
#include "nerf/splats/gaussian_fit.h"
#include "nerf/splats/renderer_pool.h"

namespace nerf {

// How Gaussians were made.
struct FitFacts {
  std::int64_t steps = 0;        // iterations
  double seconds = 0;            // of the fit
  std::int64_t field_step = -1;  // of the field at whose surfaces it began; -1: of none
};

// Gaussians of a run, with what is needed to render them.
class GaussianModel : public SceneModel {
 public:
  //   near  means nearer to a camera are not drawn, normalized units
  GaussianModel(Config config, SceneFacts scene, GaussianCloud cloud, double near,
                const FitFacts& made);

  // Exact, whatever the quality; throws InputError for another one than 1.
  RenderedView Render(const ViewRequest& view) const override;
  const Config& GetConfig() const override { return config_; }
  const SceneFacts& Scene() const override { return scene_; }
  std::int64_t Step() const override { return made_.steps; }
  const FitFacts& Made() const { return made_; }
  const GaussianCloud& Cloud() const { return cloud_; }
  double Near() const { return near_; }

 private:
  Config config_;
  SceneFacts scene_;
  GaussianCloud cloud_;
  double near_;
  FitFacts made_;
  std::shared_ptr<RendererPool> renderers_ = std::make_shared<RendererPool>();
  std::shared_ptr<LensCoverage> lens_ = std::make_shared<LensCoverage>();
};

// A fit that has not ended.
struct InterruptedFit {
  GaussianFitState state;
  // Its plan: the seconds of the whole fit, or where these are 0 its iterations.
  double planned_seconds = 0;
  std::int64_t planned_steps = 0;
  double seconds_per_frame = 0;  // no more Gaussians than are drawn in this time; 0: no limit
};

// Writes a model to a file, and reads it back. Throws InputError naming a file that is missing,
// damaged, or none of Gaussians.
//   fit  where it has not ended; its cloud is that of the model
void WriteGaussians(const GaussianModel& model, const std::filesystem::path& file,
                    const InterruptedFit* fit = nullptr);
GaussianModel ReadGaussians(const std::filesystem::path& file);
// The fit that made a file, to go on with; nullopt where it has ended.
std::optional<InterruptedFit> ReadInterruptedFit(const std::filesystem::path& file);

}  // namespace nerf
