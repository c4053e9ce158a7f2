#include "nerf/capture/relight.h"

#include <algorithm>
#include <cmath>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/progress.h"
#include "nerf/base/quantile.h"
#include "nerf/light/units.h"

namespace nerf {
namespace {

constexpr double kBright = 0.98;  // fraction of pixels that are below kBrightValue
constexpr double kBrightValue = 0.8;

// sum += weight * image, channel by channel.
void Add(const Image& image, const Color& weight, Image& sum) {
  const Eigen::Array3f w = weight.cast<float>();
  const auto pixels = static_cast<std::int64_t>(image.pixels.size() / 3);
  ParallelFor(pixels, 1 << 16, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin) * 3; i < static_cast<std::size_t>(end) * 3;
         i += 3) {
      for (std::size_t c = 0; c < 3; ++c) {
        sum.pixels[i + c] += w[static_cast<int>(c)] * image.pixels[i + c];
      }
    }
  });
}

}  // namespace

std::vector<Color> RelightWeights(const OlatCapture& capture, const LightVoronoi& cells,
                                  const EnvironmentMap& map, double degrees) {
  std::vector<Color> weights = cells.Integrate(map, degrees);
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] /= capture.lights[i].irradiance;
  return weights;
}

bool Relight(const OlatCapture& capture, InputEncoding encoding,
             const std::vector<std::vector<Color>>& weights, std::int64_t memory,
             const std::function<bool()>& keep_on,
             const std::function<void(int, const Image&)>& consume) {
  const auto image_bytes =
      std::int64_t{capture.width} * capture.height * 3 * static_cast<std::int64_t>(sizeof(float));
  const int sets = static_cast<int>(weights.size());
  // One image is being read, and its decoder needs memory for another.
  const int at_once =
      static_cast<int>(std::clamp<std::int64_t>(memory / image_bytes - 2, 1, std::max(1, sets)));
  const int passes = (sets + at_once - 1) / at_once;
  const auto images = static_cast<int>(capture.images.size());
  ProgressLine progress("relighting", std::int64_t{passes} * images);
  for (int first = 0; first < sets; first += at_once) {
    const int count = std::min(at_once, sets - first);
    std::vector<Image> sums(static_cast<std::size_t>(count),
                            Image(capture.width, capture.height, 3, ColorEncoding::kLinear));
    for (int i = 0; i < images; ++i) {
      if (!keep_on()) return false;
      const auto& file = capture.images[static_cast<std::size_t>(i)];
      progress.Update(std::int64_t{first / at_once} * images + i, file.filename().string());
      const Image image = ReadLinearImage(file, encoding);
      if (image.width != capture.width || image.height != capture.height) {
        throw InputError("{}: {} x {} pixels, but the capture has {} x {}", file.string(),
                         image.width, image.height, capture.width, capture.height);
      }
      for (int s = 0; s < count; ++s) {
        const Color& weight =
            weights[static_cast<std::size_t>(first + s)][static_cast<std::size_t>(i)];
        if (!weight.isZero(0)) Add(image, weight, sums[static_cast<std::size_t>(s)]);
      }
    }
    for (int s = 0; s < count; ++s) consume(first + s, sums[static_cast<std::size_t>(s)]);
  }
  return true;
}

void CheckNotBlack(const OlatCapture& capture, InputEncoding encoding) {
  const auto is_black = [&](const std::filesystem::path& file) {
    const Image image = ReadLinearImage(file, encoding);
    return std::ranges::none_of(image.pixels, [](float value) { return value > 0; });
  };
  if (!std::ranges::all_of(capture.images, is_black)) return;
  throw InputError("{}: all {} images are black; photograph the subject with the lights on",
                   capture.images.front().parent_path().string(), capture.images.size());
}

double AutoExposure(const Image& picture) {
  std::vector<float> brightest;
  for (std::size_t i = 0; i < picture.pixels.size(); i += 3) {
    const float* pixel = &picture.pixels[i];
    brightest.push_back(std::max({pixel[0], pixel[1], pixel[2]}));
  }
  const double value = Quantile(brightest, kBright);
  return value > 0 ? std::log2(kBrightValue / value) : 0;
}

Image WithExposure(Image picture, double stops) {
  const auto factor = static_cast<float>(FactorFromStops(stops));
  for (float& value : picture.pixels) value *= factor;
  return picture;
}

}  // namespace nerf
