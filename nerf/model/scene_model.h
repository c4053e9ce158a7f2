#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>

#include "nerf/config/config.h"
#include "nerf/model/scene_facts.h"
#include "nerf/render/image_renderer.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// A view to render, in the frame and units of the input.
struct ViewRequest {
  Camera camera;
  Eigen::Isometry3d world_from_camera;  // OpenCV axes
  double quality = 1;                   // 0 (fast) to 1 (exact): RenderQuality::Of
  // Called with the number of pixels done; throw from it to stop.
  std::function<void(std::int64_t)> progress = {};
  bool surface = false;  // also median depth and normals, of Gaussians only
};

// A trained representation of a scene: the neural field, or Gaussians. Immutable; all members are
// const and thread-safe.
class SceneModel {
 public:
  virtual ~SceneModel() = default;

  // Transparent pixels have the display background (white if photographs have alpha, else black),
  // and those outside the lens's field of view have it in pictures of the field. Depth is along the
  // ray, in normalized units. Throws InputError if quality is not in [0, 1].
  virtual RenderedView Render(const ViewRequest& view) const = 0;
  virtual const Config& GetConfig() const = 0;
  virtual const SceneFacts& Scene() const = 0;
  // Of the training.
  virtual std::int64_t Step() const = 0;
};

}  // namespace nerf
