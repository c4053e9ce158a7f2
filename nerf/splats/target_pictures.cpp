#include "nerf/splats/target_pictures.h"

#include "nerf/scene/camera.h"

namespace nerf {

std::vector<TargetView> TargetViewsOf(const std::vector<View>& views) {
  std::vector<TargetView> targets;
  for (const View& view : views) {
    targets.push_back({&view, view.camera, view.normalized_from_camera});
  }
  return targets;
}

TargetPicture TargetOf(const TargetView& view) {
  const View& photograph = *view.photograph;
  TargetPicture target;
  target.Resize(photograph.camera.width, photograph.camera.height);
  const std::array<float, 4> scale = {1 / view.gains[0], 1 / view.gains[1], 1 / view.gains[2], 1};
  for (std::int64_t k = 0; k < photograph.StoredCount(); ++k) {
    const std::int64_t pixel = photograph.PixelIndex(k);
    const auto y = static_cast<int>(pixel / target.width),
               x = static_cast<int>(pixel % target.width);
    for (int plane = 0; plane < 4; ++plane) {
      target.Row(plane, y)[x] = static_cast<float>(photograph.rgba[4 * k + plane]) * scale[plane];
    }
    target.Row(TargetPicture::kWeight, y)[x] = 1;
  }
  for (int i = 0; i < view.halvings; ++i) target = Halved(target);
  return target;
}

TargetView Reduced(TargetView view, int halvings) {
  view.camera = Downscaled(view.camera, 1 << halvings);
  view.halvings += halvings;
  return view;
}

}  // namespace nerf
