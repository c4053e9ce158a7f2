#include "nerf/reference/ssim_reference.h"

#include <cmath>
#include <functional>

namespace nerf::reference {
namespace {

double Weight(int dx, int dy) { return std::exp(-(dx * dx + dy * dy) / (2 * 1.5 * 1.5)); }

double WindowMean(const std::function<double(int, int)>& value) {
  double sum = 0;
  double total = 0;
  for (int dy = -5; dy <= 5; ++dy) {
    for (int dx = -5; dx <= 5; ++dx) {
      sum += Weight(dx, dy) * value(dx, dy);
      total += Weight(dx, dy);
    }
  }
  return sum / total;
}

}  // namespace

double Ssim(const Image& a, const Image& b) {
  double sum = 0;
  int count = 0;
  for (int c = 0; c < a.channels; ++c) {
    for (int y = 5; y < a.height - 5; ++y) {
      for (int x = 5; x < a.width - 5; ++x) {
        const auto at = [&](const Image& image, int dx, int dy) -> double {
          return image.At(x + dx, y + dy)[c];
        };
        const double mu_a = WindowMean([&](int dx, int dy) { return at(a, dx, dy); });
        const double mu_b = WindowMean([&](int dx, int dy) { return at(b, dx, dy); });
        const auto covariance = [&](const Image& p, double mu_p, const Image& q, double mu_q) {
          return WindowMean(
              [&](int dx, int dy) { return (at(p, dx, dy) - mu_p) * (at(q, dx, dy) - mu_q); });
        };
        const double c1 = 0.0001;
        const double c2 = 0.0009;
        sum += (2 * mu_a * mu_b + c1) / (mu_a * mu_a + mu_b * mu_b + c1) *
               (2 * covariance(a, mu_a, b, mu_b) + c2) /
               (covariance(a, mu_a, a, mu_a) + covariance(b, mu_b, b, mu_b) + c2);
        ++count;
      }
    }
  }
  return sum / count;
}

}  // namespace nerf::reference
