#include "nerf/splats/target_pictures.h"

namespace nerf {

TargetPicture TargetOf(const View& view) {
  TargetPicture target;
  target.Resize(view.camera.width, view.camera.height);
  for (std::int64_t k = 0; k < view.StoredCount(); ++k) {
    const std::int64_t pixel = view.PixelIndex(k);
    const auto y = static_cast<int>(pixel / target.width),
               x = static_cast<int>(pixel % target.width);
    for (int plane = 0; plane < 4; ++plane) {
      target.Row(plane, y)[x] = static_cast<float>(view.rgba[4 * k + plane]);
    }
    target.Row(TargetPicture::kWeight, y)[x] = 1;
  }
  return target;
}

}  // namespace nerf
