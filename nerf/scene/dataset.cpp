#include "nerf/scene/dataset.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/random.h"
#include "nerf/geometry/rays.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

constexpr std::int64_t kBytesPerPixel = 4 * sizeof(Eigen::half);

std::int64_t PixelsOf(const Camera& camera) {
  return static_cast<std::int64_t>(camera.width) * camera.height;
}

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
  view.whole = std::move(photograph.whole);
  view.rgba.resize(4 * plan.HeldOf(view.whole.empty()
                                       ? PixelsOf(view.camera)
                                       : static_cast<std::int64_t>(view.whole.size())));
  for (std::int64_t k = 0; k < view.Held(); ++k) {
    const float* from = &pixels.pixels[view.PixelOf(k) * pixels.channels];
    // The sun in an HDR image is brighter than a half can say.
    constexpr float kMostHalf = 65504.0f;
    for (int c = 0; c < 3; ++c) {
      view.rgba[4 * k + c] = Eigen::half(std::clamp(from[c], -kMostHalf, kMostHalf));
    }
    view.rgba[4 * k + 3] = Eigen::half(pixels.channels == 4 ? from[3] : 1.0f);
  }
  return view;
}

bool HasTransparentPixel(const Image& image) {
  if (image.channels != 4) return false;
  for (std::size_t i = 3; i < image.pixels.size(); i += 4) {
    // As it is held: what rounds to opaque is opaque.
    if (static_cast<float>(Eigen::half(image.pixels[i])) < 1.0f) return true;
  }
  return false;
}

// Whether some photograph shows anything at all.
bool ShowsSomething(const std::vector<View>& views) {
  return std::ranges::any_of(views, [](const View& view) {
    for (std::size_t i = 3; i < view.rgba.size(); i += 4) {
      if (view.rgba[i] > Eigen::half(0)) return true;
    }
    return false;
  });
}

// How many photographs may be decoded at once: each takes a float image and another while it is
// turned or reduced.
std::int64_t Decoders(const PosedImages& posed, const DataOptions& options) {
  std::int64_t largest = 1;
  for (const auto& camera : posed.cameras) largest = std::max(largest, PixelsOf(camera));
  const std::int64_t bytes = 2 * largest * 4 * static_cast<std::int64_t>(sizeof(float));
  const std::int64_t fit = (static_cast<std::int64_t>(options.memory_mb) << 20) / bytes;
  return std::clamp<std::int64_t>(fit, 1, NumThreads());
}

}  // namespace

std::int64_t DataPlan::Bytes() const { return held * kBytesPerPixel; }

std::int64_t DataPlan::HeldOf(std::int64_t pixels_of_photo) const {
  if (held == pixels) return pixels_of_photo;
  const double share = static_cast<double>(held) / static_cast<double>(pixels);
  return std::max<std::int64_t>(
      1, static_cast<std::int64_t>(share * static_cast<double>(pixels_of_photo)));
}

DataPlan PlanData(const PosedImages& posed, const DataOptions& options) {
  DataPlan plan;
  for (const PosedImage& image : posed.images) {
    if (image.split == Split::kTest) {
      ++plan.held_out;
      continue;
    }
    ++(image.split == Split::kValidation ? plan.validation : plan.train);
    plan.pixels += PixelsOf(Downscaled(posed.cameras[image.camera], options.downscale));
  }
  const std::int64_t fit = (static_cast<std::int64_t>(options.memory_mb) << 20) / kBytesPerPixel;
  plan.held = std::min(plan.pixels, fit);
  return plan;
}

std::int64_t View::Choices() const {
  return ShowsAll() ? PixelsOf(camera) : static_cast<std::int64_t>(whole.size());
}

std::int64_t View::PixelOf(std::int64_t k) const {
  const std::int64_t all = Choices(), held = Held();
  std::int64_t choice = k;
  if (held < all) {
    constexpr std::uint64_t kHeldStream = 0x68656c645f5f5f5full;
    const std::int64_t begin = all * k / held, end = all * (k + 1) / held;
    const std::uint64_t bits = RandomBits(seed, kHeldStream, static_cast<std::uint64_t>(k));
    choice = begin + static_cast<std::int64_t>(bits % static_cast<std::uint64_t>(end - begin));
  }
  return ShowsAll() ? choice : whole[choice];
}

std::int64_t View::HeldNear(std::int64_t pixel) const {
  std::int64_t choice = pixel;
  if (!ShowsAll()) {
    choice = std::ranges::lower_bound(whole, static_cast<std::uint32_t>(pixel)) - whole.begin();
    choice = std::min(choice, Choices() - 1);
  }
  return choice * Held() / Choices();
}

void AssignSplits(PosedImages& posed, const DataOptions& options) {
  std::vector<PosedImage*> by_name;
  for (PosedImage& image : posed.images) by_name.push_back(&image);
  std::ranges::sort(by_name, {}, [](const PosedImage* image) { return image->name; });

  const bool given = std::ranges::any_of(
      posed.images, [](const auto& image) { return image.split == Split::kTest; });
  constexpr std::size_t kFewestToHoldOut = 8, kFewestToValidate = 16;
  std::vector<PosedImage*> train;
  for (std::size_t i = 0; i < by_name.size(); ++i) {
    Split& split = by_name[i]->split;
    if (!given && options.test_every > 0 && by_name.size() >= kFewestToHoldOut &&
        i % options.test_every == 0) {
      split = Split::kTest;
    }
    if (split == Split::kUnspecified) split = Split::kTrain;
    if (split == Split::kTrain) train.push_back(by_name[i]);
  }
  const bool validation_given = std::ranges::any_of(
      posed.images, [](const auto& image) { return image.split == Split::kValidation; });
  if (validation_given || train.size() < kFewestToValidate) return;
  // Spread over the capture, away from its ends.
  const std::size_t count = std::min<std::size_t>(options.validation_images, train.size() / 8);
  for (std::size_t k = 0; k < count; ++k) {
    train[(2 * k + 1) * train.size() / (2 * count)]->split = Split::kValidation;
  }
}

Dataset LoadDataset(const PosedImages& posed, const DataOptions& options,
                    std::optional<MaskMeaning> masks,
                    const SceneNormalization& normalized_from_world) {
  Dataset data;
  const auto count = static_cast<std::int64_t>(posed.images.size());
  struct Loaded {
    std::optional<View> view;
    ColorEncoding encoding = ColorEncoding::kSrgb;
    bool has_alpha = false;
    std::string failure;
  };
  const DataPlan plan = PlanData(posed, options);
  if (masks) CheckMasks(posed);
  std::vector<Loaded> loaded(count);
  const std::int64_t decoders = Decoders(posed, options);
  data.made_linear = DisplayReferredAmongLinear(posed);
  const PhotographOptions photographs = {options.downscale, masks, data.made_linear > 0};
  std::atomic<std::int64_t> next = 0;
  ParallelForEach(decoders, [&](std::int64_t) {
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

  for (std::int64_t i = 0; i < count; ++i) {
    if (!loaded[i].failure.empty()) data.skipped.push_back(loaded[i].failure);
    if (!loaded[i].view) continue;
    data.encoding = loaded[i].encoding;
    data.has_alpha = data.has_alpha || loaded[i].has_alpha;
    auto& views = posed.images[i].split == Split::kValidation ? data.validation : data.train;
    views.push_back(std::move(*loaded[i].view));
  }
  if (data.train.empty()) {
    throw InputError("{}: no image is left to train on{}{}", posed.source.string(),
                     data.skipped.empty() ? "" : "; the first failed so: ",
                     data.skipped.empty() ? "" : data.skipped.front());
  }
  if (data.has_alpha && !ShowsSomething(data.train)) {
    throw InputError(
        "{}: every photograph is transparent everywhere; mend their alpha (or masks), or remove it",
        posed.source.string());
  }
  return data;
}

Eigen::Vector3f DisplayBackground(bool has_alpha) {
  return has_alpha ? Eigen::Vector3f::Ones() : Eigen::Vector3f::Zero();
}

}  // namespace nerf
