#include "tests/support/small_capture.h"

#include "nerf/scene/scene_normalization.h"
#include "nerf/scene/splits.h"

namespace nerf::test {

SmallCapture MakeSmallCapture(int views, int width, int height) {
  synthetic::SampleOptions options;
  options.views = views;
  options.width = width;
  options.height = height;
  SmallCapture small;
  small.capture = synthetic::MakeCapture(options);
  PosedImages& posed = small.capture.posed;
  AssignSplits(posed, DataOptions());
  small.scene.normalized_from_world = NormalizeScene(posed);
  for (std::size_t i = 0; i < posed.images.size(); ++i) {
    if (posed.images[i].split != Split::kTrain) continue;
    View view;
    view.name = posed.images[i].name;
    view.camera = posed.cameras[posed.images[i].camera];
    view.normalized_from_camera =
        small.scene.normalized_from_world.NormalizedFromCamera(posed.images[i].world_from_camera);
    const Image& photo = small.capture.views[i].photo;
    for (std::size_t p = 0; p < photo.pixels.size(); p += 3) {
      for (int c = 0; c < 3; ++c) view.rgba.emplace_back(photo.pixels[p + c]);
      view.rgba.emplace_back(1.0f);
    }
    small.data.train.push_back(std::move(view));
  }
  small.scene = FactsOf(small.data, small.scene.normalized_from_world);
  return small;
}

Config SmallConfig() {
  return LoadConfig(
      "base",
      {"encoding.log2_table_size=13", "encoding.max_resolution=256", "field.hidden_width=32",
       "occupancy.resolution=48", "march.steps_per_unit=48", "march.near_distance=1",
       "train.samples_per_batch=16384", "train.steps=400", "occupancy.coarse_to_fine_steps=300",
       "train.checkpoint_every=100", "train.validate_every=100"});
}

}  // namespace nerf::test
