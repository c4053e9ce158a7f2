#include "nerf/scene/dataset.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/geometry/rays.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/data_plan.h"
#include "nerf/scene/photograph.h"

namespace nerf {
namespace {

View MakeView(const PosedImages& posed, const PosedImage& image, Photograph photograph,
              int downscale, const SceneNormalization& normalized_from_world,
              const DataPlan& plan) {
  const Image& pixels = photograph.pixels;
  View view;
  view.name = image.name;
  view.camera = Downscaled(posed.cameras[image.camera], downscale);
  view.lens = image.camera;
  view.normalized_from_camera = normalized_from_world.NormalizedFromCamera(image.world_from_camera);
  CheckCameraCentre(view.normalized_from_camera.translation(), image.name);
  view.seed = static_cast<std::uint64_t>(&image - posed.images.data());
  view.valid_pixels = std::move(photograph.valid_pixels);
  view.rgba.resize(4 * plan.StoredPixelsOf(view.valid_pixels.empty()
                                               ? PixelCount(view.camera)
                                               : std::ssize(view.valid_pixels)));
  for (std::int64_t k = 0; k < view.StoredCount(); ++k) {
    const float* from = &pixels.pixels[view.PixelIndex(k) * pixels.channels];
    // The sun in an HDR image exceeds the range of a half.
    constexpr float kLargestHalf = 65504.0f;
    for (int c = 0; c < 3; ++c) {
      view.rgba[4 * k + c] = Eigen::half(std::clamp(from[c], -kLargestHalf, kLargestHalf));
    }
    view.rgba[4 * k + 3] = Eigen::half(pixels.channels == 4 ? from[3] : 1.0f);
  }
  return view;
}

bool HasTransparentPixel(const Image& image) {
  if (image.channels != 4) return false;
  for (std::size_t i = 3; i < image.pixels.size(); i += 4) {
    // As it is stored: what rounds to opaque is opaque.
    if (static_cast<float>(Eigen::half(image.pixels[i])) < 1.0f) return true;
  }
  return false;
}

bool AreAllTransparent(const std::vector<View>& views) {
  return std::ranges::all_of(views, [](const View& view) {
    for (std::size_t i = 3; i < view.rgba.size(); i += 4) {
      if (view.rgba[i] > Eigen::half(0)) return false;
    }
    return true;
  });
}

// How many photographs may be decoded at once: each takes a float image, and a second one while it
// is rotated or downscaled.
std::int64_t DecoderCount(const PosedImages& posed, const DataOptions& options) {
  std::int64_t largest = 1;
  for (const auto& camera : posed.cameras) largest = std::max(largest, PixelCount(camera));
  const std::int64_t bytes = 2 * largest * 4 * static_cast<std::int64_t>(sizeof(float));
  const std::int64_t fit = (static_cast<std::int64_t>(options.memory_mb) << 20) / bytes;
  return std::clamp<std::int64_t>(fit, 1, NumThreads());
}

struct LoadedView {
  std::optional<View> view;
  ColorEncoding encoding = ColorEncoding::kSrgb;
  bool has_alpha = false;
  std::string failure;  // why there is no view; empty for images that are held out
};

// One for each image of `posed`.
std::vector<LoadedView> LoadViews(const PosedImages& posed, const DataOptions& options,
                                  const PhotographOptions& photographs,
                                  const SceneNormalization& normalized_from_world) {
  const DataPlan plan = PlanData(posed, options);
  const std::int64_t count = std::ssize(posed.images);
  std::vector<LoadedView> loaded(count);
  std::atomic<std::int64_t> next = 0;
  ParallelForEach(DecoderCount(posed, options), [&](std::int64_t) {
    for (std::int64_t i = next++; i < count; i = next++) {
      const PosedImage& image = posed.images[i];
      if (image.split == Split::kTest) continue;
      try {
        Photograph photograph = LoadPhotograph(posed, image, photographs);
        loaded[i].encoding = photograph.pixels.encoding;
        loaded[i].has_alpha = HasTransparentPixel(photograph.pixels);
        loaded[i].view = MakeView(posed, image, std::move(photograph), options.downscale,
                                  normalized_from_world, plan);
      } catch (const InputError& error) {
        loaded[i].failure = error.what();
      }
    }
  });
  return loaded;
}

}  // namespace

Dataset LoadDataset(const PosedImages& posed, const DataOptions& options,
                    std::optional<MaskMeaning> masks,
                    const SceneNormalization& normalized_from_world) {
  Dataset data;
  if (masks) CheckMasks(posed);
  data.linearized_photographs = CountPhotographsToLinearize(posed);
  const PhotographOptions photographs = {options.downscale, masks, data.linearized_photographs > 0};
  std::vector<LoadedView> loaded = LoadViews(posed, options, photographs, normalized_from_world);
  for (std::size_t i = 0; i < loaded.size(); ++i) {
    if (!loaded[i].failure.empty()) data.skipped.push_back(loaded[i].failure);
    if (!loaded[i].view) continue;
    data.encoding = loaded[i].encoding;
    data.has_alpha = data.has_alpha || loaded[i].has_alpha;
    auto& views = posed.images[i].split == Split::kValidation ? data.validation : data.train;
    views.push_back(std::move(*loaded[i].view));
  }
  if (data.train.empty()) {
    throw InputError("{}: no image is left to train on{}{}", posed.source.string(),
                     data.skipped.empty() ? "" : "; the first error: ",
                     data.skipped.empty() ? "" : data.skipped.front());
  }
  if (data.has_alpha && AreAllTransparent(data.train)) {
    throw InputError(
        "{}: every photograph is fully transparent; fix their alpha (or masks), or remove it",
        posed.source.string());
  }
  return data;
}

Eigen::Vector3f DisplayBackground(bool has_alpha) {
  return has_alpha ? Eigen::Vector3f::Ones() : Eigen::Vector3f::Zero();
}

}  // namespace nerf
