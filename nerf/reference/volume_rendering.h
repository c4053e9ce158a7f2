#pragma once

#include <cstddef>
#include <vector>

namespace nerf::reference {

// One ray, composited directly by the definition in long double.
struct Ray {
  std::vector<long double> sigma, dt, t;
  std::vector<long double> radiance;  // [S,3]
  long double background[3] = {0, 0, 0};
};

struct Pixel {
  long double rgb[3] = {0, 0, 0};
  long double opacity = 0;
  long double depth = 0;
};

// w_i = T_i (1 - e^{-x_i}), with each T_i from its own sum over the samples in front.
long double Weight(const Ray& ray, std::size_t i);
long double TransmittanceBefore(const Ray& ray, std::size_t i);  // i = S: behind all samples
Pixel Composite(const Ray& ray);

// dL/dsigma_i for L = g_rgb . rgb + g_opacity opacity + g_depth depth, by the explicit O(S^2) sum
// dL/dx_i = T_{i+1} v_i - sum_{j>i} w_j v_j - T_N v_b.
std::vector<long double> GradientOfSigma(const Ray& ray, const long double g_rgb[3],
                                         long double g_opacity, long double g_depth);

}  // namespace nerf::reference
