#pragma once

#include <filesystem>

#include "nerf/model/checkpoint.h"
#include "nerf/model/scene_model.h"
#include "nerf/splats/gaussian_cloud.h"

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

// Writes a model to a file, and reads it back. Throws InputError naming a file that is missing,
// damaged, or none of Gaussians.
void WriteGaussians(const GaussianModel& model, const std::filesystem::path& file);
GaussianModel ReadGaussians(const std::filesystem::path& file);

}  // namespace nerf
