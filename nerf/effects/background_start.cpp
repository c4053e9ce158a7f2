#include "nerf/effects/background_start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace nerf {
namespace {

using Color = std::array<float, 3>;

constexpr int kCoarsest = 16;            // rows
constexpr float kAgree = 0.06f;          // of the range of a channel, sRGB
constexpr std::size_t kFewestAgree = 2;  // photographs

// Colours nearer to 0 or 1 would be infinite before the activation.
constexpr float kFaintest = 0.01f;

Color MedianOf(std::vector<Color>& colors) {
  Color median;
  const auto middle = colors.begin() + static_cast<std::ptrdiff_t>(colors.size() / 2);
  for (int c = 0; c < 3; ++c) {
    std::ranges::nth_element(colors, middle, {}, [c](const Color& color) { return color[c]; });
    median[c] = (*middle)[c];
  }
  return median;
}

// What photographs show in the direction of a texel.
struct Shown {
  std::vector<Color> all;
  std::vector<Color> of_photographs;  // the median of each
};

std::vector<Shown> ShownInTexels(std::span<const std::int64_t> photograph,
                                 std::span<const float> direction, std::span<const float> rgb,
                                 int rows) {
  std::vector<std::vector<std::size_t>> rays_of(2 * rows * rows);
  for (std::size_t r = 0; r < photograph.size(); ++r) {
    const auto around = BackgroundMap::TexelsOf(direction.subspan(3 * r).first<3>(), rows);
    const auto nearest = std::ranges::max_element(around.weight) - around.weight.begin();
    rays_of[around.index[nearest]].push_back(r);
  }
  std::vector<Shown> shown(rays_of.size());
  for (std::size_t i = 0; i < rays_of.size(); ++i) {
    std::map<std::int64_t, std::vector<Color>> by_photograph;
    for (const std::size_t r : rays_of[i]) {
      const Color color = {rgb[3 * r], rgb[3 * r + 1], rgb[3 * r + 2]};
      by_photograph[photograph[r]].push_back(color);
      shown[i].all.push_back(color);
    }
    for (auto& [_, colors] : by_photograph) shown[i].of_photographs.push_back(MedianOf(colors));
  }
  return shown;
}

// Between 0 and 1, about as eyes tell shades apart.
float Shade(float value, ColorEncoding encoding) {
  if (encoding == ColorEncoding::kSrgb) return value;
  const float light = std::max(value, 0.0f);
  return std::sqrt(light / (1 + light));
}

float Distance(const Color& a, const Color& b, ColorEncoding encoding) {
  float largest = 0;
  for (int c = 0; c < 3; ++c) {
    largest = std::max(largest, std::fabs(Shade(a[c], encoding) - Shade(b[c], encoding)));
  }
  return largest;
}

// The median of the largest group of colours about one of them; nullopt where no two agree.
std::optional<Color> Agreed(const std::vector<Color>& colors, ColorEncoding encoding) {
  std::vector<Color> largest;
  float nearest = 0;
  for (const Color& about : colors) {
    std::vector<Color> group;
    float sum = 0;
    for (const Color& other : colors) {
      const float distance = Distance(about, other, encoding);
      if (distance > kAgree) continue;
      group.push_back(other);
      sum += distance;
    }
    const bool closer = group.size() == largest.size() && sum < nearest;
    if (group.size() > largest.size() || closer) {
      largest = std::move(group);
      nearest = sum;
    }
  }
  if (largest.size() < kFewestAgree) return std::nullopt;
  return MedianOf(largest);
}

void SetTexel(const Color& color, std::size_t texel, BackgroundMap& map) {
  for (int c = 0; c < 3; ++c) {
    const float held = std::clamp(color[c], kFaintest, 1 - kFaintest);
    map.raw[3 * texel + c] = map.encoding == ColorEncoding::kSrgb
                                 ? std::log(held / (1 - held))
                                 : std::log(std::max(color[c], kFaintest));
  }
}

// Colours grow into what nobody saw, a ring of texels at a time.
void Grow(std::vector<bool> known, BackgroundMap& map) {
  const std::int64_t rows = map.rows, columns = 2 * rows;
  std::vector<std::int64_t> open;
  for (std::int64_t i = 0; i < rows * columns; ++i) {
    if (!known[i]) open.push_back(i);
  }
  while (!open.empty() && std::ssize(open) < rows * columns) {
    std::vector<std::int64_t> still;
    std::vector<std::pair<std::int64_t, Color>> found;
    for (const std::int64_t i : open) {
      const std::int64_t row = i / columns, column = i % columns;
      Color sum{};
      float count = 0;
      for (const std::int64_t beside :
           {row * columns + (column + 1) % columns,
            row * columns + (column + columns - 1) % columns,
            std::max<std::int64_t>(row - 1, 0) * columns + column,
            std::min<std::int64_t>(row + 1, rows - 1) * columns + column}) {
        if (!known[beside]) continue;
        for (int c = 0; c < 3; ++c) sum[c] += map.raw[3 * beside + c];
        ++count;
      }
      if (count == 0) {
        still.push_back(i);
        continue;
      }
      found.push_back({i, {sum[0] / count, sum[1] / count, sum[2] / count}});
    }
    for (const auto& [i, raw] : found) {
      known[i] = true;
      std::ranges::copy(raw, map.raw.begin() + 3 * i);
    }
    open = std::move(still);
  }
}

// The map of half the rows at the middle of a texel, before the activation.
Color RawOf(const BackgroundMap& coarse, std::size_t texel, int rows) {
  const std::size_t columns = 2 * static_cast<std::size_t>(rows);
  const double row = static_cast<double>(texel / columns) + 0.5;
  const double column = static_cast<double>(texel % columns) + 0.5;
  const double from_zenith = row / rows * std::numbers::pi;
  const double longitude = (column / static_cast<double>(columns) - 0.5) * 2 * std::numbers::pi;
  const std::array<float, 3> direction = {
      static_cast<float>(std::sin(from_zenith) * std::cos(longitude)),
      static_cast<float>(std::sin(from_zenith) * std::sin(longitude)),
      static_cast<float>(std::cos(from_zenith))};
  const BackgroundMap::Texels around = BackgroundMap::TexelsOf(direction, coarse.rows);
  Color raw{};
  for (int k = 0; k < 4; ++k) {
    for (int c = 0; c < 3; ++c) {
      raw[c] += around.weight[k] * coarse.raw[3 * around.index[k] + c];
    }
  }
  return raw;
}

}  // namespace

void StartFromPhotographs(std::span<const std::int64_t> photograph,
                          std::span<const float> direction, std::span<const float> rgb,
                          BackgroundMap& map) {
  std::vector<Shown> shown = ShownInTexels(photograph, direction, rgb, map.rows);
  map.raw.assign(3 * shown.size(), 0.0f);
  std::vector<bool> known(shown.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto agreed = Agreed(shown[i].of_photographs, map.encoding);
    if (agreed) SetTexel(*agreed, i, map);
    known[i] = agreed.has_value();
  }
  if (map.rows > kCoarsest) {
    BackgroundMap coarse = {map.rows / 2, map.encoding, {}};
    StartFromPhotographs(photograph, direction, rgb, coarse);
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (!known[i]) std::ranges::copy(RawOf(coarse, i, map.rows), &map.raw[3 * i]);
    }
    return;
  }
  // Where exposures differ much nobody agrees with anybody.
  const bool nobody = std::ranges::find(known, true) == known.end();
  for (std::size_t i = 0; i < known.size() && nobody; ++i) {
    if (!shown[i].all.empty()) SetTexel(MedianOf(shown[i].all), i, map);
    known[i] = !shown[i].all.empty();
  }
  Grow(std::move(known), map);
}

}  // namespace nerf
