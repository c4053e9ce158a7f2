#include "nerf/image/silhouette.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace nerf {
namespace {

constexpr float kOpaque = 0.5f;
constexpr double kNever = std::numeric_limits<double>::infinity();

// Of a row of squared distances, the least of (x - i)^2 + row[i], by the lower envelope of
// parabolas.
void Lower(std::vector<double>& row) {
  std::vector<int> apex;
  std::vector<double> from;  // where the parabola of each apex begins to be the lowest
  for (int i = 0; i < static_cast<int>(row.size()); ++i) {
    if (row[i] == kNever) continue;
    double begin = -kNever;
    while (!apex.empty()) {
      const int k = apex.back();
      begin = (row[i] + i * i - row[k] - k * k) / (2.0 * (i - k));
      if (begin > from.back()) break;
      apex.pop_back();
      from.pop_back();
      begin = -kNever;
    }
    apex.push_back(i);
    from.push_back(begin);
  }
  if (apex.empty()) return;
  std::vector<double> lowest(row.size());
  std::size_t at = 0;
  for (std::size_t x = 0; x < row.size(); ++x) {
    while (at + 1 < apex.size() && from[at + 1] < static_cast<double>(x)) ++at;
    const double offset = static_cast<double>(x) - apex[at];
    lowest[x] = offset * offset + row[static_cast<std::size_t>(apex[at])];
  }
  row = std::move(lowest);
}

// Squared distances of all pixels to those that are opaque, or to those that are not.
std::vector<double> SquaredDistances(const Image& opacity, bool to_opaque) {
  const std::size_t width = opacity.width, height = opacity.height;
  std::vector<double> squares(width * height);
  for (std::size_t i = 0; i < squares.size(); ++i) {
    squares[i] = (opacity.pixels[i] >= kOpaque) == to_opaque ? 0 : kNever;
  }
  std::vector<double> line(height);
  for (std::size_t x = 0; x < width; ++x) {
    for (std::size_t y = 0; y < height; ++y) line[y] = squares[y * width + x];
    Lower(line);
    for (std::size_t y = 0; y < height; ++y) squares[y * width + x] = line[y];
  }
  line.resize(width);
  for (std::size_t y = 0; y < height; ++y) {
    std::copy_n(squares.begin() + static_cast<std::ptrdiff_t>(y * width), width, line.begin());
    Lower(line);
    std::ranges::copy(line, squares.begin() + static_cast<std::ptrdiff_t>(y * width));
  }
  return squares;
}

}  // namespace

Image SilhouetteDistance(const Image& opacity) {
  Image distance(opacity.width, opacity.height, 1, ColorEncoding::kLinear);
  const std::vector<double> outside = SquaredDistances(opacity, true);
  const std::vector<double> inside = SquaredDistances(opacity, false);
  for (std::size_t i = 0; i < distance.pixels.size(); ++i) {
    // The border is halfway between two pixel centres.
    distance.pixels[i] = static_cast<float>(outside[i] > 0 ? std::sqrt(outside[i]) - 0.5
                                                           : 0.5 - std::sqrt(inside[i]));
  }
  return distance;
}

}  // namespace nerf
