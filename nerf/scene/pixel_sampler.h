#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "nerf/geometry/rays.h"
#include "nerf/scene/error_map.h"
#include "nerf/scene/view.h"

namespace nerf {

// Rays together with the colours that photographs show along them.
struct TargetBatch {
  RayBatch rays;
  std::vector<float> rgb;  // [R,3] composited on the ray's background where the photo has alpha
  std::vector<std::int64_t> photograph;  // [R] which of the views
  std::vector<std::int64_t> pixel;       // [R] y * width + x
  std::vector<std::int64_t> cell;        // [R] of the error map; empty where there is none
  // [R] how far each ray sees, normalized units, 0 where that is not known; empty: nowhere.
  std::vector<float> distance;
};

// Draws pixels of the training views as rays: uniformly, except for one share that the error map
// draws and one share at depth observations. The result is a function of seed, step and error map,
// and does not depend on the number of threads. `views` must outlive the sampler.
class PixelSampler {
 public:
  //   error_driven_share  of the rays, in [0,1]: drawn by the error map; 0: there is no error map
  //   depth_share         of the rays, in [0,1]: drawn at depth observations where views have some
  explicit PixelSampler(const std::vector<View>& views, double error_driven_share = 0,
                        double depth_share = 0);

  // Each ray has a random background colour, behind the prediction as behind transparent pixels, so
  // that matter cannot be replaced by a background that happens to match.
  // Throws InputError when the distortion of a lens cannot be inverted at almost any pixel.
  TargetBatch Sample(std::int64_t rays, std::uint64_t seed, std::uint64_t step) const;

  // Null where there is no error map.
  ErrorMap* Errors() { return errors_ ? &*errors_ : nullptr; }
  const ErrorMap* Errors() const { return errors_ ? &*errors_ : nullptr; }

 private:
  struct Drawn {
    std::size_t view = 0;
    std::int64_t stored = 0;  // index among the view's stored pixels
    float distance = 0;       // 0 where it is not known
  };
  std::optional<Drawn> DrawDepthObservation(std::uint64_t bits) const;
  Drawn Draw(std::uint64_t bits) const;

  const std::vector<View>& views_;
  double error_driven_share_, depth_share_;
  std::optional<ErrorMap> errors_;
  std::vector<std::int64_t> first_pixel_;        // [views+1] running count
  std::vector<std::int64_t> first_observation_;  // [views+1] running count
};

struct ViewRays {
  RayBatch rays;
  std::vector<std::uint8_t> valid;  // [R] 0: the pixel has no ray, that of the batch is undefined
};
// The rays through the centres of given pixels, all with jitter 0.5 and the same background.
//   pixels   [R] y * width + x
//   returns  valid 0 where the distortion cannot be inverted at a pixel
ViewRays RaysOfPixels(const Camera& camera, const Eigen::Isometry3d& normalized_from_camera,
                      std::span<const std::int64_t> pixels, const Eigen::Vector3f& background);

}  // namespace nerf
