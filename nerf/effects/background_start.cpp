#include "nerf/effects/background_start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "nerf/base/quantile.h"

namespace nerf {
namespace {

using Rgb = std::array<float, 3>;

constexpr int kCoarsest = 16;                  // rows
constexpr float kAgree = 0.06f;                // largest difference of agreeing perceptual colours
constexpr std::size_t kFewestAgree = 2;        // photographs
constexpr std::size_t kMostPhotographs = 128;  // evaluated per texel, to bound the quadratic search
constexpr double kUsualAgreement = 0.1;        // share of the covered texels with agreement

// Colours are clamped away from 0 and 1, whose inverse activations are infinite.
constexpr float kFaintest = 0.01f;

// The median of each channel.
Rgb MedianOf(const std::vector<Rgb>& colors) {
  Rgb median;
  std::vector<float> values(colors.size());
  for (int c = 0; c < 3; ++c) {
    std::ranges::transform(colors, values.begin(), [c](const Rgb& color) { return color[c]; });
    median[c] = Median(values);
  }
  return median;
}

// The colours that photographs show in the direction of a texel: each photograph's median.
using TexelColors = std::vector<Rgb>;

std::vector<TexelColors> CollectTexelColors(std::span<const std::int64_t> photograph,
                                            std::span<const float> direction,
                                            std::span<const float> rgb, int rows) {
  std::vector<std::map<std::int64_t, std::vector<Rgb>>> colors_of(2 * rows * rows);
  for (std::size_t r = 0; r < photograph.size(); ++r) {
    const auto around = BackgroundMap::TexelsOf(direction.subspan(3 * r).first<3>(), rows);
    const auto nearest = std::ranges::max_element(around.weight) - around.weight.begin();
    colors_of[around.index[nearest]][photograph[r]].push_back(
        {rgb[3 * r], rgb[3 * r + 1], rgb[3 * r + 2]});
  }
  std::vector<TexelColors> shown(colors_of.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    for (auto& [_, colors] : colors_of[i]) {
      if (shown[i].size() < kMostPhotographs) shown[i].push_back(MedianOf(colors));
    }
  }
  return shown;
}

// A roughly perceptually uniform scale, so that one tolerance fits all colours: the logarithm of
// linear light, which makes the comparison independent of its unit.
Rgb PerceptualOf(const Rgb& color, ColorEncoding encoding) {
  constexpr float kPerFactorE = 0.3f, kBlack = 1e-6f;
  Rgb perceptual = color;
  if (encoding == ColorEncoding::kSrgb) return perceptual;
  for (float& p : perceptual) p = kPerFactorE * std::log(std::max(p, kBlack));
  return perceptual;
}

// The median of the largest group of colours within kAgree of one of them; of equally large groups
// the tightest. nullopt where no two agree.
std::optional<Rgb> AgreedColor(const TexelColors& shown, ColorEncoding encoding) {
  std::vector<Rgb> perceptual;
  for (const Rgb& color : shown) perceptual.push_back(PerceptualOf(color, encoding));
  const auto distance = [&](std::size_t i, std::size_t k) {
    float largest = 0;
    for (int c = 0; c < 3; ++c) {
      largest = std::max(largest, std::fabs(perceptual[i][c] - perceptual[k][c]));
    }
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
  std::vector<Rgb> group;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    if (distance(best, k) <= kAgree) group.push_back(shown[k]);
  }
  return MedianOf(group);
}

void SetTexel(const Rgb& color, std::size_t texel, BackgroundMap& map) {
  for (int c = 0; c < 3; ++c) {
    const float clamped = std::clamp(color[c], kFaintest, 1 - kFaintest);
    map.raw[3 * texel + c] = map.encoding == ColorEncoding::kSrgb
                                 ? std::log(clamped / (1 - clamped))
                                 : std::log(std::max(color[c], kFaintest));
  }
}

// Fills unknown texels with the mean of their known neighbours, one ring of texels at a time.
void FillUnknown(std::vector<bool> known, BackgroundMap& map) {
  const std::int64_t rows = map.rows, columns = 2 * rows;
  std::vector<std::int64_t> unknown;
  for (std::int64_t i = 0; i < rows * columns; ++i) {
    if (!known[i]) unknown.push_back(i);
  }
  while (!unknown.empty() && std::ssize(unknown) < rows * columns) {
    std::vector<std::int64_t> still_unknown;
    std::vector<std::pair<std::int64_t, Rgb>> filled;
    for (const std::int64_t i : unknown) {
      const std::int64_t row = i / columns, column = i % columns;
      Rgb sum{};
      float count = 0;
      for (const std::int64_t neighbour :
           {row * columns + (column + 1) % columns,
            row * columns + (column + columns - 1) % columns,
            std::max<std::int64_t>(row - 1, 0) * columns + column,
            std::min<std::int64_t>(row + 1, rows - 1) * columns + column}) {
        if (!known[neighbour]) continue;
        for (int c = 0; c < 3; ++c) sum[c] += map.raw[3 * neighbour + c];
        ++count;
      }
      if (count == 0) {
        still_unknown.push_back(i);
        continue;
      }
      filled.push_back({i, {sum[0] / count, sum[1] / count, sum[2] / count}});
    }
    for (const auto& [i, raw] : filled) {
      known[i] = true;
      std::ranges::copy(raw, map.raw.begin() + 3 * i);
    }
    unknown = std::move(still_unknown);
  }
}

// The map of half the rows, interpolated at the centre of a texel, before the activation.
Rgb UpsampledRaw(const BackgroundMap& coarse, std::size_t texel, int rows) {
  const std::size_t columns = 2 * static_cast<std::size_t>(rows);
  const double row = static_cast<double>(texel / columns) + 0.5;
  const double column = static_cast<double>(texel % columns) + 0.5;
  const double polar = row / rows * std::numbers::pi;
  const double longitude = (column / static_cast<double>(columns) - 0.5) * 2 * std::numbers::pi;
  const std::array<float, 3> direction = {static_cast<float>(std::sin(polar) * std::cos(longitude)),
                                          static_cast<float>(std::sin(polar) * std::sin(longitude)),
                                          static_cast<float>(std::cos(polar))};
  const BackgroundMap::Texels around = BackgroundMap::TexelsOf(direction, coarse.rows);
  Rgb raw{};
  for (int k = 0; k < 4; ++k) {
    for (int c = 0; c < 3; ++c) {
      raw[c] += around.weight[k] * coarse.raw[3 * around.index[k] + c];
    }
  }
  return raw;
}

}  // namespace

void InitializeBackground(std::span<const std::int64_t> photograph,
                          std::span<const float> direction, std::span<const float> rgb,
                          BackgroundMap& map) {
  std::vector<TexelColors> shown = CollectTexelColors(photograph, direction, rgb, map.rows);
  map.raw.assign(3 * shown.size(), 0.0f);
  std::vector<bool> known(shown.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto agreed = AgreedColor(shown[i], map.encoding);
    if (agreed) SetTexel(*agreed, i, map);
    known[i] = agreed.has_value();
  }
  if (map.rows > kCoarsest) {
    shown = {};
    BackgroundMap coarse = {map.rows / 2, map.encoding, {}};
    InitializeBackground(photograph, direction, rgb, coarse);
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (!known[i]) std::ranges::copy(UpsampledRaw(coarse, i, map.rows), &map.raw[3 * i]);
    }
    return;
  }
  // Where exposures differ, a few texels agree only by chance: the medians are used instead.
  const auto covered =
      std::ranges::count_if(shown, [](const TexelColors& s) { return !s.empty(); });
  const auto agreed = std::ranges::count(known, true);
  const bool usual = static_cast<double>(agreed) >= kUsualAgreement * static_cast<double>(covered);
  for (std::size_t i = 0; i < known.size() && !usual; ++i) {
    if (!shown[i].empty()) SetTexel(MedianOf(shown[i]), i, map);
    known[i] = !shown[i].empty();
  }
  FillUnknown(std::move(known), map);
}

}  // namespace nerf
