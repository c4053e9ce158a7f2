#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <string>

#include "nerf/image/image.h"
#include "nerf/scene/posed_images.h"
#include "nerf/transport/path_tracer.h"

namespace nerf {

struct RenderSettings {
  int places = 4;            // within each pixel, the same in each pixel, 1..64
  int paths_per_place = 16;  // 1..1,000,000
  double stop_at_noise = 0;  // relative; ends earlier where it is reached; 0: all paths
  std::uint64_t seed = 0;

  // Throws InputError, naming the value, where it is out of range.
  void Check() const;
};

struct SceneRendering {
  Image color;       // 3 channels, linear radiance
  Image deviation;   // 1 channel: standard deviation of the mean luminance of each pixel
  double noise = 0;  // root mean square of `deviation` over the mean luminance
  std::int64_t rays = 0;
  bool finished = true;  // not stopped by keep_on
};

// Renders a scene by paths, in passes of one path a place, on several threads. Long renders show
// progress with the noise that is left. The same settings give the same pixels whatever the number
// of threads.
//   title    of the progress line; empty: none
//   keep_on  asked between passes; false ends the render with what there is
// Throws InputError: settings out of range, a pixel for which the camera has no ray.
SceneRendering RenderScene(
    const SurfaceScene& scene, const TransportTerms& terms, const Camera& camera,
    const Eigen::Isometry3d& world_from_camera, const RenderSettings& settings,
    const std::string& title = "", const std::function<bool()>& keep_on = [] { return true; });

}  // namespace nerf
