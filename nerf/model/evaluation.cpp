#include "nerf/model/evaluation.h"

#include <algorithm>
#include <cmath>

#include "nerf/base/input_error.h"
#include "nerf/base/stopwatch.h"
#include "nerf/effects/exposure_fit.h"
#include "nerf/image/image_metrics.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/photograph.h"

namespace nerf {
namespace {

// Replaces the pixels of the rendering that a mask ignores by those of the photograph.
//   whole    pixels that are not ignored; empty: all
//   returns  dB by which this raises the PSNR of the whole image over that of these pixels
double IgnoreMasked(const std::vector<std::uint32_t>& whole, const Image& truth, Image& rendered) {
  if (whole.empty()) return 0;
  Image counted = rendered.encoding == ColorEncoding::kLinear ? ToLinear(truth) : truth;
  for (const std::uint32_t pixel : whole) {
    std::copy_n(&rendered.pixels[3 * pixel], 3, &counted.pixels[3 * pixel]);
  }
  rendered = std::move(counted);
  const double all = static_cast<double>(truth.width) * truth.height;
  return 10 * std::log10(all / static_cast<double>(whole.size()));
}

}  // namespace

void RenderCost::Add(const RenderedView& view) {
  ++views;
  pixels += static_cast<std::int64_t>(view.rgb.width) * view.rgb.height;
  if (std::int64_t{view.rgb.width} * view.rgb.height > std::int64_t{width} * height) {
    width = view.rgb.width;
    height = view.rgb.height;
  }
  samples += view.samples;
  seconds.Add(view.seconds);
}

ViewScore Evaluation::Mean() const {
  ViewScore mean{"mean", 0, 0, 0};
  for (const ViewScore& s : scores) {
    mean.psnr += s.psnr;
    mean.ssim += s.ssim;
    mean.seconds += s.seconds;
  }
  const auto count = static_cast<double>(scores.size());
  return {mean.name, mean.psnr / count, mean.ssim / count, mean.seconds / count};
}

std::vector<const PosedImage*> ImagesOf(const PosedImages& posed, Split split) {
  std::vector<const PosedImage*> images;
  for (const PosedImage& image : posed.images) {
    if (image.split == split) images.push_back(&image);
  }
  return images;
}

Evaluation Evaluate(const SceneModel& model, const PosedImages& posed,
                    const std::vector<const PosedImage*>& images, const EvaluationOptions& options,
                    const std::function<void(const EvaluatedView&)>& listener) {
  const Config& config = model.GetConfig();
  const SceneFacts& scene = model.Scene();
  const int downscale = options.downscale.value_or(config.data.downscale);
  const Eigen::Vector3f background = DisplayBackground(scene.has_alpha);
  Evaluation evaluation;
  evaluation.exposure_fitted = options.fit_exposure || config.effects.exposure;
  for (const PosedImage* image : images) {
    LapTimer reading;
    Photograph photograph;
    try {
      photograph = LoadPhotograph(posed, *image, {downscale, MeaningOf(config.effects.masks)});
    } catch (const InputError& error) {
      evaluation.unreadable.emplace_back(error.what());
      continue;
    }
    const Image truth = OnWhite(photograph.pixels);
    reading.Lap(evaluation.cost.reading);
    const Stopwatch watch;
    RenderedView view = model.Render({Downscaled(posed.cameras[image->camera], downscale),
                                      image->world_from_camera, options.quality});
    const double seconds = watch.Seconds();
    evaluation.cost.Add(view);
    if (evaluation.exposure_fitted) {
      const Image shown = view.rgb.encoding == ColorEncoding::kLinear ? ToLinear(truth) : truth;
      FitExposure(view.rgb.pixels, view.opacity.pixels, shown.pixels, {background.data(), 3},
                  view.rgb.encoding);
    }
    const double of_ignored = IgnoreMasked(photograph.valid_pixels, truth, view.rgb);
    const ViewScore& score = evaluation.scores.emplace_back(
        image->name, Psnr(truth, view.rgb) - of_ignored, Ssim(truth, view.rgb), seconds);
    if (listener) listener({image, &truth, &view.rgb, &score});
  }
  return evaluation;
}

}  // namespace nerf
