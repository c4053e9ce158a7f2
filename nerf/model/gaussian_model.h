#pragma once

#include <filesystem>
#include <optional>

#include "nerf/model/checkpoint.h"
#include "nerf/model/scene_model.h"
#include "nerf/splats/gaussian_cloud.h"
#include "nerf/splats/gaussian_fit.h"

namespace nerf {

// Gaussians of a run, with what is needed to render them.
class GaussianModel : public SceneModel {
 public:
  //   near  means nearer to a camera are not drawn, normalized units
  GaussianModel(Config config, SceneFacts scene, GaussianCloud cloud, double near,
                std::int64_t step);

  // Exact, whatever the quality; throws InputError for another one than 1.
  RenderedView Render(const ViewRequest& view) const override;
  const Config& GetConfig() const override { return config_; }
  const SceneFacts& Scene() const override { return scene_; }
  std::int64_t Step() const override { return step_; }
  const GaussianCloud& Cloud() const { return cloud_; }
  double Near() const { return near_; }

 private:
  Config config_;
  SceneFacts scene_;
  GaussianCloud cloud_;
  double near_;
  std::int64_t step_;
};

// A fit that has not ended.
struct InterruptedFit {
  GaussianFitState state;
  double seconds = 0;  // spent on it so far
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
