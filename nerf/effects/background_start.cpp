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
constexpr float kAgree = 0.06f;          // shades apart
constexpr std::size_t kFewestAgree = 2;  // photographs
constexpr std::size_t kMostAsked = 128;  // photographs of a texel; more say no more
constexpr double kUsual = 0.1;           // share of the texels in which photographs agree

// Colours nearer to 0 or 1 would be infinite before the activation.
constexpr float kFaintest = 0.01f;

Color MedianOf(std::vector<Color>& colors) {
  Color median;
  const std::size_t high = colors.size() / 2, low = (colors.size() - 1) / 2;
  for (int c = 0; c < 3; ++c) {
    std::ranges::sort(colors, {}, [c](const Color& color) { return color[c]; });
    median[c] = (colors[low][c] + colors[high][c]) / 2;
  }
  return median;
}

// What photographs show in the direction of a texel: the median of each.
using Shown = std::vector<Color>;

std::vector<Shown> ShownInTexels(std::span<const std::int64_t> photograph,
                                 std::span<const float> direction, std::span<const float> rgb,
                                 int rows) {
  std::vector<std::map<std::int64_t, std::vector<Color>>> colors_of(2 * rows * rows);
  for (std::size_t r = 0; r < photograph.size(); ++r) {
    const auto around = BackgroundMap::TexelsOf(direction.subspan(3 * r).first<3>(), rows);
    const auto nearest = std::ranges::max_element(around.weight) - around.weight.begin();
    colors_of[around.index[nearest]][photograph[r]].push_back(
        {rgb[3 * r], rgb[3 * r + 1], rgb[3 * r + 2]});
  }
  std::vector<Shown> shown(colors_of.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    for (auto& [_, colors] : colors_of[i]) {
      if (shown[i].size() < kMostAsked) shown[i].push_back(MedianOf(colors));
    }
  }
  return shown;
}

// In which colours that eyes tell apart about as well are as far apart; of linear light whatever
// its unit.
Color ShadeOf(const Color& color, ColorEncoding encoding) {
  constexpr float kShadesOfAFactorE = 0.3f, kBlack = 1e-6f;
  Color shade = color;
  if (encoding == ColorEncoding::kSrgb) return shade;
  for (float& s : shade) s = kShadesOfAFactorE * std::log(std::max(s, kBlack));
  return shade;
}

// The median of the largest group of colours about one of them, the closest of those as large;
// nullopt where no two agree.
std::optional<Color> Agreed(const Shown& shown, ColorEncoding encoding) {
  std::vector<Color> shades;
  for (const Color& color : shown) shades.push_back(ShadeOf(color, encoding));
  const auto distance = [&](std::size_t i, std::size_t k) {
    float largest = 0;
    for (int c = 0; c < 3; ++c) largest = std::max(largest, std::fabs(shades[i][c] - shades[k][c]));
    return largest;
  };
  std::size_t best = 0, largest = 0;
  float closest = 0;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    std::size_t count = 0;
    float sum = 0;
    for (std::size_t k = 0; k < shown.size(); ++k) {
      const float apart = distance(i, k);
      if (apart > kAgree) continue;
      ++count;
      sum += apart;
    }
    if (count < largest || (count == largest && sum >= closest)) continue;
    best = i;
    largest = count;
    closest = sum;
  }
  if (largest < kFewestAgree) return std::nullopt;
  std::vector<Color> group;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    if (distance(best, k) <= kAgree) group.push_back(shown[k]);
  }
  return MedianOf(group);
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
    const auto agreed = Agreed(shown[i], map.encoding);
    if (agreed) SetTexel(*agreed, i, map);
    known[i] = agreed.has_value();
  }
  if (map.rows > kCoarsest) {
    shown = {};
    BackgroundMap coarse = {map.rows / 2, map.encoding, {}};
    StartFromPhotographs(photograph, direction, rgb, coarse);
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (!known[i]) std::ranges::copy(RawOf(coarse, i, map.rows), &map.raw[3 * i]);
    }
    return;
  }
  // Where exposures differ some agree by chance.
  const auto asked = std::ranges::count_if(shown, [](const Shown& s) { return !s.empty(); });
  const auto agreed = std::ranges::count(known, true);
  const bool usual = static_cast<double>(agreed) >= kUsual * static_cast<double>(asked);
  for (std::size_t i = 0; i < known.size() && !usual; ++i) {
    if (!shown[i].empty()) SetTexel(MedianOf(shown[i]), i, map);
    known[i] = !shown[i].empty();
  }
  Grow(std::move(known), map);
}

}  // namespace nerf
