#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "nerf/geometry/rays.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/error_map.h"

namespace nerf {

// Rays together with the colours that photographs show along them.
struct TargetBatch {
  RayBatch rays;
  std::vector<float> rgb;  // [R,3] composited on the ray's background where the photo has alpha
  std::vector<std::int64_t> photograph;  // [R] which of the views
  std::vector<std::int64_t> cell;        // [R] of the error map; empty where there is none
  // [R] how far each ray sees, normalized units, 0 where that is not known; empty: nowhere.
  std::vector<float> distance;
};

// Draws pixels of the training views as rays: each equally likely, but for a share of them that
// stands where the field is still wrong, and a share that goes through the points of views that
// have some. What is drawn is a function of seed, step and the error map, whatever the number of
// threads. `views` must outlive the sampler.
class PixelSampler {
 public:
  explicit PixelSampler(const std::vector<View>& views, double error_driven_share = 0,
                        double point_share = 0);

  // The background of each ray is a random colour: it tells matter from a lucky backdrop, in the
  // prediction as in the transparent pixels of a photograph.
  // Throws InputError when a lens lets no pixel through.
  TargetBatch Sample(std::int64_t rays, std::uint64_t seed, std::uint64_t step) const;

  // Null where all pixels are equally likely.
  ErrorMap* Errors() { return errors_ ? &*errors_ : nullptr; }
  const ErrorMap* Errors() const { return errors_ ? &*errors_ : nullptr; }

 private:
  struct Drawn {
    std::size_t view = 0;
    std::int64_t held = 0;  // which of the view's held pixels
    float distance = 0;     // where it is known
  };
  std::optional<Drawn> DrawPoint(std::uint64_t bits) const;
  Drawn Draw(std::uint64_t bits) const;

  const std::vector<View>& views_;
  double error_driven_share_, point_share_;
  std::optional<ErrorMap> errors_;
  std::vector<std::int64_t> first_pixel_;  // [views+1] running count
  std::vector<std::int64_t> first_point_;  // [views+1] running count
};

// The rays through the centres of given pixels of a view, without jitter (0.5), on one background.
//   pixels  [R] y * width + x
// Pixels that the lens does not reach get `valid` 0 and a ray that must not be used.
struct ViewRays {
  RayBatch rays;
  std::vector<std::uint8_t> valid;  // [R]
};
ViewRays RaysOfPixels(const Camera& camera, const Eigen::Isometry3d& normalized_from_camera,
                      std::span<const std::int64_t> pixels, const Eigen::Vector3f& background);

}  // namespace nerf
