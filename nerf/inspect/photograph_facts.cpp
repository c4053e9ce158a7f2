#include "nerf/inspect/photograph_facts.h"

#include <algorithm>
#include <cmath>

#include "nerf/base/input_error.h"
#include "nerf/image/image_convert.h"
#include "nerf/image/image_io.h"
#include "nerf/scene/photograph.h"

namespace nerf {
namespace {

constexpr std::size_t kMostExamined = 8;

struct Sums {
  double pixels = 0, transparent = 0, above_white = 0;
  double masked_pixels = 0, masked = 0, sum = 0, squares = 0;  // the last two of masked values

  void Add(const Image& photograph) {
    for (std::size_t i = 0; i < photograph.pixels.size(); i += photograph.channels) {
      const float* const at = &photograph.pixels[i];
      ++pixels;
      if (photograph.channels == 4 && at[3] < 0.5f) ++transparent;
      if (std::max({at[0], at[1], at[2]}) > 1) ++above_white;
    }
  }
  void AddMasked(const Image& photograph, const Image& mask) {
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
      ++masked_pixels;
      if (mask.pixels[i] > 0) continue;
      for (int c = 0; c < 3; ++c) {
        const auto value = static_cast<double>(photograph.pixels[i * photograph.channels + c]);
        ++masked;
        sum += value;
        squares += value * value;
      }
    }
  }
};

}  // namespace

PhotographFacts ExaminePhotographs(const PosedImages& posed) {
  PhotographFacts facts;
  facts.photographs = static_cast<int>(posed.images.size());
  std::vector<const PosedImage*> with_mask, all;
  for (const PosedImage& image : posed.images) {
    all.push_back(&image);
    if (!image.mask.empty()) with_mask.push_back(&image);
  }
  facts.masks = static_cast<int>(with_mask.size());
  const std::vector<const PosedImage*>& from = with_mask.empty() ? all : with_mask;
  const std::size_t count = std::min(kMostExamined, from.size());
  Sums sums;
  for (std::size_t k = 0; k < count; ++k) {
    const PosedImage& image = *from[k * from.size() / count];
    Image photograph;
    try {
      photograph = ReadImage(image.path, image.upright_by_exif);
    } catch (const InputError&) {
      continue;  // training reports and skips it
    }
    ++facts.examined;
    facts.linear = facts.linear || photograph.encoding == ColorEncoding::kLinear;
    sums.Add(photograph);
    if (image.mask.empty()) continue;
    sums.AddMasked(ToSrgb(photograph), ReadMaskOf(image, photograph));
  }
  const auto share = [](double part, double whole) { return whole > 0 ? part / whole : 0.0; };
  facts.transparent = share(sums.transparent, sums.pixels);
  facts.above_white = share(sums.above_white, sums.pixels);
  facts.masked_out = share(sums.masked / 3, sums.masked_pixels);
  const double mean = share(sums.sum, sums.masked);
  facts.masked_spread = std::sqrt(std::max(0.0, share(sums.squares, sums.masked) - mean * mean));
  return facts;
}

}  // namespace nerf
