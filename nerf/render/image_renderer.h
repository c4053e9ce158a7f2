#pragma once

#include <Eigen/Geometry>
#include <functional>

#include "nerf/image/image.h"
#include "nerf/render/ray_renderer.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// A rendered view. Pixels that the lens does not reach are the background with opacity 0.
struct RenderedView {
  Image rgb;      // 3 channels
  Image opacity;  // 1 channel, [0,1]
  Image depth;    // 1 channel, distance along the ray in normalized scene units, 0 where undefined
  std::int64_t samples = 0;  // points at which the field was evaluated
  StageSeconds seconds;
};

// Renders every pixel of a camera, a tile of rays at a time, so that memory does not grow with the
// size of the image beyond the image itself. Rays go in blocks of 4 x 4 pixels, a block in squares
// of 2 x 2: every 16 and every 4 rays of a batch, in order, are neighbours.
//   progress  called with the number of pixels done, after each tile; throw from it to stop
RenderedView RenderView(const RayRenderer& renderer, const Camera& camera,
                        const Eigen::Isometry3d& normalized_from_camera,
                        const Eigen::Vector3f& background, ColorEncoding encoding,
                        const std::function<void(std::int64_t)>& progress = {});

// The picture of a camera from every `factor`-th ray across and down, each repeated over the pixels
// that it stands for: a first look, in 1 / factor^2 of the time.
Image RenderPreview(const RayRenderer& renderer, const Camera& camera, int factor,
                    const Eigen::Isometry3d& normalized_from_camera,
                    const Eigen::Vector3f& background, ColorEncoding encoding);

}  // namespace nerf
