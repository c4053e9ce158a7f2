#include "nerf/model/dial.h"

#include <algorithm>
#include <limits>

#include "nerf/base/stopwatch.h"
#include "nerf/image/image_metrics.h"
#include "nerf/model/view_renderer.h"
#include "nerf/render/image_renderer.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

// Rows of a strip, a whole number of blocks, and the part of the picture that strips cover.
constexpr int kStripRows = 16;
constexpr int kPart = 8;

// Halvings of the dial: to 1/32.
constexpr int kHalvings = 5;

}  // namespace

Dial::Dial(const Model& model, const Camera& camera,
           const Eigen::Isometry3d& normalized_from_camera)
    : model_(model), normalized_from_camera_(normalized_from_camera) {
  const int rows = std::min(kStripRows, camera.height);
  const int count = std::max(1, camera.height / (kPart * rows));
  for (int i = 0; i < count; ++i) {
    // In the middle of equal parts of the picture.
    const int middle = camera.height * (2 * i + 1) / (2 * count);
    strips_.push_back(CropRows(camera, std::max(0, middle - rows / 2), rows));
  }
  strips_in_a_frame_ = static_cast<double>(camera.height) / (count * rows);
  exact_ = Render(1, exact_seconds_);
}

Image Dial::Render(double quality, double& seconds) const {
  const SceneFacts& scene = model_.scene;
  const auto renderer = ViewRenderer(model_, quality);
  const int rows = strips_.front().height;
  Image all(strips_.front().width, rows * static_cast<int>(strips_.size()), 3, scene.encoding);
  const Stopwatch watch;
  auto to = all.pixels.begin();
  for (const Camera& strip : strips_) {
    const RenderedView view = RenderView(*renderer, strip, normalized_from_camera_,
                                         DisplayBackground(scene.has_alpha), scene.encoding);
    to = std::ranges::copy(view.rgb.pixels, to).out;
  }
  seconds = watch.Seconds() * strips_in_a_frame_;
  return all;
}

DialPosition Dial::Measure(double quality) const {
  if (quality == 1) return {1, exact_seconds_, std::numeric_limits<double>::infinity()};
  DialPosition position{quality, 0, 0};
  position.psnr = Psnr(exact_, Render(quality, position.seconds));
  return position;
}

DialPosition Dial::Choose(double seconds) const {
  if (exact_seconds_ <= seconds) return Measure(1);
  DialPosition best = Measure(0);
  if (best.seconds > seconds) return best;
  double too_slow = 1;
  for (int i = 0; i < kHalvings; ++i) {
    const DialPosition tried = Measure((best.quality + too_slow) / 2);
    if (tried.seconds <= seconds) {
      best = tried;
    } else {
      too_slow = tried.quality;
    }
  }
  return best;
}

}  // namespace nerf
