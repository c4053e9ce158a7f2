#include "nerf/render/image_renderer.h"

#include <algorithm>

#include "nerf/data/pixel_sampler.h"

namespace nerf {

RenderedView RenderView(RayRenderer& renderer, const sfm::Camera& camera,
                        const Eigen::Isometry3d& normalized_from_camera,
                        const Eigen::Vector3f& background, ColorEncoding encoding,
                        const std::function<void(std::int64_t)>& progress) {
  constexpr std::int64_t kTile = 4096;
  RenderedView view = {Image(camera.width, camera.height, 3, encoding),
                       Image(camera.width, camera.height, 1, ColorEncoding::kLinear),
                       Image(camera.width, camera.height, 1, ColorEncoding::kLinear)};
  const std::int64_t pixels = static_cast<std::int64_t>(camera.width) * camera.height;
  for (std::int64_t first = 0; first < pixels; first += kTile) {
    const std::int64_t last = std::min(pixels, first + kTile);
    ViewRays tile = RaysOfPixels(camera, normalized_from_camera, first, last, background);
    // Unreached pixels: a ray that starts beyond the scene and looks away meets nothing.
    for (std::int64_t r = 0; r < last - first; ++r) {
      if (tile.valid[r]) continue;
      for (int c = 0; c < 3; ++c) {
        tile.rays.origin[3 * r + c] = c == 0 ? 1e6f : 0.0f;
        tile.rays.direction[3 * r + c] = c == 0 ? 1.0f : 0.0f;
      }
    }
    const RenderOutput out = renderer.Render(tile.rays);
    std::copy(out.rgb.begin(), out.rgb.end(), view.rgb.pixels.begin() + 3 * first);
    std::copy(out.opacity.begin(), out.opacity.end(), view.opacity.pixels.begin() + first);
    std::copy(out.depth.begin(), out.depth.end(), view.depth.pixels.begin() + first);
    for (std::int64_t r = 0; r < last - first; ++r) {
      if (tile.valid[r]) continue;
      for (int c = 0; c < 3; ++c) view.rgb.pixels[3 * (first + r) + c] = background[c];
      view.opacity.pixels[first + r] = 0;
      view.depth.pixels[first + r] = 0;
    }
    if (progress) progress(last);
  }
  return view;
}

}  // namespace nerf
