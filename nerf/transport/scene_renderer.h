#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <string>

#include "nerf/image/image.h"
#include "nerf/scene/posed_images.h"
#include "nerf/transport/path_tracer.h"
#include "nerf/transport/pixel_rays.h"

namespace nerf {

// Where in a pixel the i-th position is; the first is its centre.
inline Eigen::Vector2d PositionInPixel(int i) { return PointInPixel(i, {0.5, 0.5}); }

struct RenderSettings {
  int positions = 4;            // within each pixel, the same in all pixels, 1..64
  int paths_per_position = 16;  // 1..1,000,000
  double stop_at_noise = 0;     // stops early when `noise` is as low; 0: never
  std::uint64_t seed = 0;

  // Throws InputError, naming the value, if it is out of range.
  void Check() const;
};

struct SceneRendering {
  Image color;       // 3 channels, linear radiance
  Image deviation;   // 1 channel: standard deviation of the mean luminance of each pixel
  double noise = 0;  // root mean square of `deviation` over the mean luminance
  std::int64_t rays = 0;
  bool finished = true;  // not stopped by keep_on
};

// Renders a scene by path tracing, in passes of one path for each position in a pixel, on several
// threads. The pixels depend on the settings alone, not on the number of threads.
//   title    of the progress line, which also shows the noise; empty: no progress line
//   keep_on  called between passes; false ends the rendering with the passes so far
// Throws InputError if settings are out of range or the camera has no ray for a pixel.
SceneRendering RenderScene(
    const SurfaceScene& scene, const TransportTerms& terms, const Camera& camera,
    const Eigen::Isometry3d& world_from_camera, const RenderSettings& settings,
    const std::string& title = "", const std::function<bool()>& keep_on = [] { return true; });

}  // namespace nerf
