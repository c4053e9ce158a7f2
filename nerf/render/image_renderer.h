#pragma once

#include <Eigen/Geometry>
#include <functional>

#include "nerf/image/image.h"
#include "nerf/render/ray_renderer.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// A rendered view. Pixels outside the lens's field of view have the background and opacity 0.
struct RenderedView {
  Image rgb;      // 3 channels
  Image opacity;  // 1 channel, [0,1]
  Image depth;    // 1 channel, distance along the ray in normalized units, 0 where undefined
  // Where ViewRequest::surface asks for them, else empty.
  Image median_depth;  // 1 channel, behind which less than half of the light is left; 0: nowhere
  Image normal;        // 3 channels, towards the camera, in the normalized frame; 0 where undefined
  std::int64_t samples = 0;  // points at which the field was evaluated
  StageSeconds seconds;
};

// Renders all pixels of a camera in batches of bounded size. Rays are in blocks of 4 x 4 pixels,
// a block in squares of 2 x 2: every 16 and every 4 successive rays of a batch are neighbours.
//   progress  called with the number of pixels done, after each batch; throw from it to stop
RenderedView RenderView(const RayRenderer& renderer, const Camera& camera,
                        const Eigen::Isometry3d& normalized_from_camera,
                        const Eigen::Vector3f& background, ColorEncoding encoding,
                        const std::function<void(std::int64_t)>& progress = {});

// A preview in 1 / factor^2 of the time: renders at a resolution reduced by `factor`, and repeats
// each pixel to fill the image.
Image RenderPreview(const RayRenderer& renderer, const Camera& camera, int factor,
                    const Eigen::Isometry3d& normalized_from_camera,
                    const Eigen::Vector3f& background, ColorEncoding encoding);

}  // namespace nerf
