#include "nerf/model/quality_probe.h"

#include <algorithm>
#include <limits>

#include "nerf/base/stopwatch.h"
#include "nerf/image/image_metrics.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

// Rows of a strip, a whole number of blocks; the strips cover one part in kPart of the picture.
constexpr int kStripRows = 16;
constexpr int kPart = 8;

// Steps of the bisection of quality: to 1/32.
constexpr int kBisections = 5;

}  // namespace

QualityProbe::QualityProbe(const ModelSnapshot& model, const ViewRequest& view) : model_(model) {
  const Camera& camera = view.camera;
  const int rows = std::min(kStripRows, camera.height);
  const int count = std::max(1, camera.height / (kPart * rows));
  for (int i = 0; i < count; ++i) {
    // At the centres of equal parts of the picture.
    const int middle = camera.height * (2 * i + 1) / (2 * count);
    strips_.push_back(
        {CropRows(camera, std::max(0, middle - rows / 2), rows), view.world_from_camera});
  }
  strips_per_frame_ = static_cast<double>(camera.height) / (count * rows);
  exact_ = Render(1, exact_seconds_);
}

Image QualityProbe::Render(double quality, double& seconds) const {
  const SceneFacts& scene = model_.Scene();
  const auto renderer = model_.Renderer(quality);
  const Camera& first = strips_.front().camera;
  Image all(first.width, first.height * static_cast<int>(strips_.size()), 3, scene.encoding);
  const Stopwatch watch;
  auto to = all.pixels.begin();
  for (const ViewRequest& strip : strips_) {
    const RenderedView view =
        RenderView(*renderer, strip.camera,
                   scene.normalized_from_world.NormalizedFromCamera(strip.world_from_camera),
                   DisplayBackground(scene.has_alpha), scene.encoding);
    to = std::ranges::copy(view.rgb.pixels, to).out;
  }
  seconds = watch.Seconds() * strips_per_frame_;
  return all;
}

MeasuredQuality QualityProbe::Measure(double quality) const {
  if (quality == 1) return {1, exact_seconds_, std::numeric_limits<double>::infinity()};
  MeasuredQuality measured{quality, 0, 0};
  measured.psnr = Psnr(exact_, Render(quality, measured.seconds));
  return measured;
}

MeasuredQuality QualityProbe::Choose(double seconds) const {
  if (exact_seconds_ <= seconds) return Measure(1);
  MeasuredQuality best = Measure(0);
  if (best.seconds > seconds) return best;
  double too_slow = 1;
  for (int i = 0; i < kBisections; ++i) {
    const MeasuredQuality tried = Measure((best.quality + too_slow) / 2);
    if (tried.seconds <= seconds) {
      best = tried;
    } else {
      too_slow = tried.quality;
    }
  }
  return best;
}

}  // namespace nerf
