#include "sfm/frame_choice.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "nerf/base/quantile.h"

namespace nerf::sfm {
namespace {

constexpr double kBlurred = 0.25;  // of the median around it
constexpr int kAround = 5;         // frames on each side

}  // namespace

double Sharpness(std::span<const std::uint8_t> grey, int width, int height) {
  double sum = 0, squares = 0;
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      const std::uint8_t* const at = &grey[static_cast<std::size_t>(y) * width + x];
      const double laplacian = at[-1] + at[1] + at[-width] + at[width] - 4 * at[0];
      sum += laplacian;
      squares += laplacian * laplacian;
    }
  }
  const double count = std::max(0, width - 2) * static_cast<double>(std::max(0, height - 2));
  return count > 0 ? squares / count - (sum / count) * (sum / count) : 0;
}

std::vector<int> ChooseFrames(std::span<const double> sharpness, int count) {
  const auto frames = static_cast<std::int64_t>(sharpness.size());
  std::vector<int> sharpest;
  for (std::int64_t part = 0; part < count; ++part) {
    const std::int64_t begin = part * frames / count, end = (part + 1) * frames / count;
    if (begin == end) continue;
    const auto best = std::max_element(sharpness.begin() + begin, sharpness.begin() + end);
    sharpest.push_back(static_cast<int>(best - sharpness.begin()));
  }
  std::vector<int> chosen;
  for (int i = 0; i < static_cast<int>(sharpest.size()); ++i) {
    std::vector<double> around;
    const int last = std::min(static_cast<int>(sharpest.size()) - 1, i + kAround);
    for (int k = std::max(0, i - kAround); k <= last; ++k) {
      around.push_back(sharpness[sharpest[k]]);
    }
    if (sharpness[sharpest[i]] >= kBlurred * UpperMedian(around)) chosen.push_back(sharpest[i]);
  }
  return chosen;
}

int DefaultFrameCount(double seconds) {
  return static_cast<int>(std::lround(std::clamp(3 * seconds, 40.0, 150.0)));
}

}  // namespace nerf::sfm
