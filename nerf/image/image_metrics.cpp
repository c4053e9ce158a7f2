#include "nerf/image/image_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "nerf/base/input_error.h"

namespace nerf {
namespace {

constexpr int kWindow = 11;
constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 0.01;
constexpr double kC2 = 0.03 * 0.03;

struct Pair {
  Image a;
  Image b;
};

Pair AsSaved(const Image& a, const Image& b) {
  Pair pair{Quantized(OnWhite(a)), Quantized(OnWhite(b))};
  if (a.width != b.width || a.height != b.height || pair.a.channels != pair.b.channels ||
      a.pixels.empty()) {
    throw InputError("images of {} x {} and {} x {} pixels cannot be compared", a.width, a.height,
                     b.width, b.height);
  }
  return pair;
}

std::array<double, kWindow> GaussianWindow() {
  std::array<double, kWindow> window{};
  double sum = 0;
  for (int i = 0; i < kWindow; ++i) {
    const double x = (i - kWindow / 2) / kSigma;
    window[i] = std::exp(-0.5 * x * x);
    sum += window[i];
  }
  for (double& w : window) w /= sum;
  return window;
}

// Window means along one row of the image, one entry per colour value, colours interleaved.
struct RowMoments {
  explicit RowMoments(std::size_t size) : a(size), b(size), aa(size), bb(size), ab(size) {}
  std::vector<double> a, b, aa, bb, ab;
};

// The vertical pass of the separable window, over the rows from y on.
void SumDown(const Pair& pair, int y, const std::array<double, kWindow>& window, RowMoments& sums) {
  for (auto* row : {&sums.a, &sums.b, &sums.aa, &sums.bb, &sums.ab}) std::ranges::fill(*row, 0.0);
  for (int i = 0; i < kWindow; ++i) {
    const double w = window[i];
    const float* row_a = pair.a.At(0, y + i);
    const float* row_b = pair.b.At(0, y + i);
    for (std::size_t k = 0; k < sums.a.size(); ++k) {
      const double a = row_a[k];
      const double b = row_b[k];
      sums.a[k] += w * a;
      sums.b[k] += w * b;
      sums.aa[k] += w * a * a;
      sums.bb[k] += w * b * b;
      sums.ab[k] += w * a * b;
    }
  }
}

// The horizontal pass.
void SumAlong(const std::vector<double>& from, int channels,
              const std::array<double, kWindow>& window, std::vector<double>& to) {
  std::ranges::fill(to, 0.0);
  for (int i = 0; i < kWindow; ++i) {
    const double* shifted = from.data() + static_cast<std::ptrdiff_t>(i) * channels;
    for (std::size_t k = 0; k < to.size(); ++k) to[k] += window[i] * shifted[k];
  }
}

double SumOfSimilarity(const RowMoments& mean) {
  double sum = 0;
  for (std::size_t k = 0; k < mean.a.size(); ++k) {
    const double a = mean.a[k];
    const double b = mean.b[k];
    const double variances = mean.aa[k] - a * a + mean.bb[k] - b * b;
    const double covariance = mean.ab[k] - a * b;
    sum += (2 * a * b + kC1) * (2 * covariance + kC2) / ((a * a + b * b + kC1) * (variances + kC2));
  }
  return sum;
}

}  // namespace

double Psnr(const Image& a, const Image& b) {
  const Pair pair = AsSaved(a, b);
  double sum = 0;
  for (std::size_t i = 0; i < pair.a.pixels.size(); ++i) {
    const double difference = static_cast<double>(pair.a.pixels[i]) - pair.b.pixels[i];
    sum += difference * difference;
  }
  if (sum == 0) return std::numeric_limits<double>::infinity();
  return -10 * std::log10(sum / static_cast<double>(pair.a.pixels.size()));
}

double Ssim(const Image& a, const Image& b) {
  const Pair pair = AsSaved(a, b);
  if (a.width < kWindow || a.height < kWindow) {
    throw InputError("SSIM needs images of at least {0} x {0} pixels, these have {1} x {2}",
                     kWindow, a.width, a.height);
  }
  const std::array<double, kWindow> window = GaussianWindow();
  const int channels = pair.a.channels;
  const int rows = a.height - kWindow + 1;
  const std::size_t columns = static_cast<std::size_t>(a.width - kWindow + 1) * channels;
  RowMoments down(static_cast<std::size_t>(a.width) * channels);
  RowMoments mean(columns);
  double sum = 0;
  for (int y = 0; y < rows; ++y) {
    SumDown(pair, y, window, down);
    SumAlong(down.a, channels, window, mean.a);
    SumAlong(down.b, channels, window, mean.b);
    SumAlong(down.aa, channels, window, mean.aa);
    SumAlong(down.bb, channels, window, mean.bb);
    SumAlong(down.ab, channels, window, mean.ab);
    sum += SumOfSimilarity(mean);
  }
  return sum / (static_cast<double>(rows) * static_cast<double>(columns));
}

}  // namespace nerf
