#include "nerf/data/dataset.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>

#include "nerf/data/camera.h"
#include "nerf/data/image_io.h"
#include "nerf/parallel.h"
#include "sfm/input_error.h"

namespace nerf {
namespace {

View MakeView(const sfm::PosedImages& posed, const sfm::PosedImage& image, const Image& pixels,
              int downscale, const sfm::SceneNormalization& normalized_from_world) {
  View view;
  view.name = image.name;
  view.camera = Downscaled(posed.cameras[image.camera], downscale);
  view.normalized_from_camera = normalized_from_world.NormalizedFromCamera(image.world_from_camera);
  view.rgba.resize(static_cast<std::size_t>(pixels.width) * pixels.height * 4);
  for (std::size_t i = 0; i < view.rgba.size() / 4; ++i) {
    const float* from = &pixels.pixels[i * pixels.channels];
    // The sun in an HDR image is brighter than a half can say.
    constexpr float kMostHalf = 65504.0f;
    for (int c = 0; c < 3; ++c) {
      view.rgba[4 * i + c] = Eigen::half(std::clamp(from[c], -kMostHalf, kMostHalf));
    }
    view.rgba[4 * i + 3] = Eigen::half(pixels.channels == 4 ? from[3] : 1.0f);
  }
  return view;
}

bool HasTransparentPixel(const View& view) {
  for (std::size_t i = 3; i < view.rgba.size(); i += 4) {
    if (static_cast<float>(view.rgba[i]) < 1.0f) return true;
  }
  return false;
}

}  // namespace

void DataOptions::Check() const {
  if (downscale < 1)
    throw sfm::InputError("config: data.downscale is {}; use 1 or more", downscale);
  if (test_every < 0 || test_every == 1) {
    throw sfm::InputError("config: data.test_every is {}; use 2 or more, or 0 to hold out none",
                          test_every);
  }
  if (validation_images < 0) {
    throw sfm::InputError("config: data.validation_images is {}; use 0 or more", validation_images);
  }
}

void AssignSplits(sfm::PosedImages& posed, const DataOptions& options) {
  std::vector<sfm::PosedImage*> by_name;
  for (sfm::PosedImage& image : posed.images) by_name.push_back(&image);
  std::ranges::sort(by_name, {}, [](const sfm::PosedImage* image) { return image->name; });

  const bool given = std::ranges::any_of(
      posed.images, [](const auto& image) { return image.split == sfm::Split::kTest; });
  constexpr std::size_t kFewestToHoldOut = 8, kFewestToValidate = 16;
  std::vector<sfm::PosedImage*> train;
  for (std::size_t i = 0; i < by_name.size(); ++i) {
    sfm::Split& split = by_name[i]->split;
    if (!given && options.test_every > 0 && by_name.size() >= kFewestToHoldOut &&
        i % options.test_every == 0) {
      split = sfm::Split::kTest;
    }
    if (split == sfm::Split::kUnspecified) split = sfm::Split::kTrain;
    if (split == sfm::Split::kTrain) train.push_back(by_name[i]);
  }
  const bool validation_given = std::ranges::any_of(
      posed.images, [](const auto& image) { return image.split == sfm::Split::kValidation; });
  if (validation_given || train.size() < kFewestToValidate) return;
  // Spread over the capture, away from its ends.
  const std::size_t count = std::min<std::size_t>(options.validation_images, train.size() / 8);
  for (std::size_t k = 0; k < count; ++k) {
    train[(2 * k + 1) * train.size() / (2 * count)]->split = sfm::Split::kValidation;
  }
}

Image LoadPhotograph(const sfm::PosedImages& posed, const sfm::PosedImage& image, int downscale) {
  Image pixels = ReadImage(image.path, image.upright_by_exif);
  const sfm::Camera& camera = posed.cameras[image.camera];
  if (pixels.width != camera.width || pixels.height != camera.height) {
    throw sfm::InputError(
        "{}: is {}x{} pixels, but its camera in {} is {}x{}; give the photographs that the poses "
        "were made from",
        image.path.string(), pixels.width, pixels.height, posed.source.string(), camera.width,
        camera.height);
  }
  return downscale == 1 ? pixels : Downscale(pixels, downscale);
}

Dataset LoadDataset(const sfm::PosedImages& posed, const DataOptions& options,
                    const sfm::SceneNormalization& normalized_from_world) {
  Dataset data;
  const auto count = static_cast<std::int64_t>(posed.images.size());
  struct Loaded {
    std::optional<View> view;
    ColorEncoding encoding = ColorEncoding::kSrgb;
    std::string failure;
  };
  std::vector<Loaded> loaded(count);
  ParallelFor(count, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      const sfm::PosedImage& image = posed.images[i];
      if (image.split == sfm::Split::kTest) continue;
      try {
        const Image pixels = LoadPhotograph(posed, image, options.downscale);
        loaded[i].encoding = pixels.encoding;
        loaded[i].view = MakeView(posed, image, pixels, options.downscale, normalized_from_world);
      } catch (const sfm::InputError& error) {
        loaded[i].failure = error.what();
      }
    }
  });

  std::optional<ColorEncoding> encoding;
  for (std::int64_t i = 0; i < count; ++i) {
    if (!loaded[i].failure.empty()) data.skipped.push_back(loaded[i].failure);
    if (!loaded[i].view) continue;
    if (encoding && *encoding != loaded[i].encoding) {
      throw sfm::InputError(
          "{}: photographs and linear (EXR, HDR) images are mixed; convert them to one kind",
          posed.images[i].path.string());
    }
    encoding = loaded[i].encoding;
    data.has_alpha = data.has_alpha || HasTransparentPixel(*loaded[i].view);
    auto& views = posed.images[i].split == sfm::Split::kValidation ? data.validation : data.train;
    views.push_back(std::move(*loaded[i].view));
  }
  data.encoding = encoding.value_or(ColorEncoding::kSrgb);
  if (data.train.empty()) {
    throw sfm::InputError("{}: no image is left to train on{}{}", posed.source.string(),
                          data.skipped.empty() ? "" : "; the first failed so: ",
                          data.skipped.empty() ? "" : data.skipped.front());
  }
  return data;
}

Eigen::Vector3f DisplayBackground(bool has_alpha) {
  return has_alpha ? Eigen::Vector3f::Ones() : Eigen::Vector3f::Zero();
}

}  // namespace nerf
