#pragma once

#include <spdlog/fmt/fmt.h>

#include "nerf/scene/camera.h"
#include "nerf/scene/posed_images.h"

namespace nerf::test {

// Images 000.png, 001.png, ... of one camera of 4 x 4 pixels, without files.
inline PosedImages NumberedImages(int count) {
  PosedImages posed;
  posed.cameras.push_back(PinholeFromFov(4, 4, 1.0));
  posed.source = "test";
  for (int i = 0; i < count; ++i) {
    PosedImage image;
    image.name = fmt::format("{:03}.png", i);
    image.world_from_camera = Eigen::Isometry3d::Identity();
    posed.images.push_back(image);
  }
  return posed;
}

}  // namespace nerf::test
