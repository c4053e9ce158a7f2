#include "nerf/pipeline/gaussian_validation.h"

#include <utility>

#include "nerf/splats/gaussian_camera.h"
#include "nerf/splats/gaussian_renderer.h"

namespace nerf {

GaussianValidation::GaussianValidation(const GaussianScene& scene, const Dataset& data)
    : scene_(scene), validation_(data.validation, scene.config.train.seed) {}

double GaussianValidation::Psnr(const GaussianCloud& cloud, double near) const {
  const TargetBatch& targets = validation_.Targets();
  RenderOutput drawn;
  drawn.rgb.resize(targets.rgb.size());
  drawn.opacity.resize(targets.photograph.size());
  GaussianRenderer renderer;
  for (std::size_t v = 0; v < scene_.validation.size(); ++v) {
    const TargetView& view = scene_.validation[v];
    const GaussianPicture& picture = renderer.Draw(
        MakeGaussianCamera(view.camera, view.normalized_from_camera, near), cloud.Parameters());
    for (std::size_t r = 0; r < targets.photograph.size(); ++r) {
      if (targets.photograph[r] != static_cast<std::int64_t>(v)) continue;
      const std::int64_t y = targets.pixel[r] / picture.width;
      const std::int64_t x = targets.pixel[r] % picture.width;
      const auto at = static_cast<std::size_t>(y * picture.stride + x);
      // Opaque photographs are fitted before black, as `nerf eval` draws them.
      const float T =
          scene_.facts.has_alpha ? picture.Plane(GaussianPicture::kTransmittance)[at] : 0.0f;
      drawn.opacity[r] = 1 - T;
      for (std::size_t c = 0; c < 3; ++c) {
        drawn.rgb[3 * r + c] =
            picture.Plane(static_cast<int>(c))[at] + T * targets.rays.background[3 * r + c];
      }
    }
  }
  return validation_.Psnr(std::move(drawn), scene_.config.effects.exposure.has_value(),
                          scene_.facts.encoding);
}

double GaussianValidation::Psnr(const Model& field) const {
  return validation_.Psnr(field, field.exposure != nullptr);
}

}  // namespace nerf
