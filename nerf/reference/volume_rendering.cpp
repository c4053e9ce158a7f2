#include "nerf/reference/volume_rendering.h"

#include <cmath>
#include <cstddef>

namespace nerf::reference {
namespace {

long double OpticalDepth(const Ray& ray, std::size_t i) {
  return ray.dt[i] == 0 ? 0 : ray.sigma[i] * ray.dt[i];
}

}  // namespace

long double TransmittanceBefore(const Ray& ray, std::size_t i) {
  long double tau = 0;
  for (std::size_t j = 0; j < i; ++j) tau += OpticalDepth(ray, j);
  return std::exp(-tau);
}

long double Weight(const Ray& ray, std::size_t i) {
  return TransmittanceBefore(ray, i) * -std::expm1(-OpticalDepth(ray, i));
}

Pixel Composite(const Ray& ray) {
  Pixel pixel;
  const std::size_t count = ray.sigma.size();
  for (std::size_t i = 0; i < count; ++i) {
    const long double w = Weight(ray, i);
    for (int c = 0; c < 3; ++c) pixel.rgb[c] += w * ray.radiance[3 * i + c];
    pixel.opacity += w;
    pixel.depth += w * ray.t[i];
  }
  for (int c = 0; c < 3; ++c) {
    pixel.rgb[c] += TransmittanceBefore(ray, count) * ray.background[c];
  }
  return pixel;
}

std::vector<long double> GradientOfSigma(const Ray& ray, const long double g_rgb[3],
                                         long double g_opacity, long double g_depth) {
  const std::size_t count = ray.sigma.size();
  const auto value = [&](std::size_t i) {
    long double v = g_opacity + g_depth * ray.t[i];
    for (int c = 0; c < 3; ++c) v += g_rgb[c] * ray.radiance[3 * i + c];
    return v;
  };
  long double value_behind = 0;
  for (int c = 0; c < 3; ++c) value_behind += g_rgb[c] * ray.background[c];

  std::vector<long double> gradient(count);
  for (std::size_t i = 0; i < count; ++i) {
    long double suffix = TransmittanceBefore(ray, count) * value_behind;
    for (std::size_t j = i + 1; j < count; ++j) suffix += Weight(ray, j) * value(j);
    gradient[i] = ray.dt[i] * (TransmittanceBefore(ray, i + 1) * value(i) - suffix);
  }
  return gradient;
}

}  // namespace nerf::reference
