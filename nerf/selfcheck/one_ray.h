#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "nerf/kernels/volume_rendering.h"
#include "nerf/reference/volume_rendering.h"

namespace nerf {

inline const std::vector<float> kRed = {1, 0, 0};

// One ray for the compositing kernels in Real (float or double) and for their reference.
template <class Real>
struct OneRay {
  std::vector<Real> sigma, dt, t, radiance;
  std::vector<Real> background = {Real(0.2), Real(0.4), Real(0.6)};

  struct Pixel {
    Real rgb[3] = {}, opacity = 0, depth = 0;
  };
  struct Gradients {
    std::vector<Real> sigma, radiance, background;
  };

  std::size_t Size() const { return sigma.size(); }

  // Appends a sample behind the last one; the first interval begins at distance 1.
  void Add(Real density, Real length, Real r = Real(0.5), Real g = Real(0.25),
           Real b = Real(0.75)) {
    const Real begin = t.empty() ? Real(1) : t.back() + dt.back() / 2;
    sigma.push_back(density);
    dt.push_back(length);
    t.push_back(begin + length / 2);
    radiance.insert(radiance.end(), {r, g, b});
  }

  // Densities from e^-3 to e^3.
  static OneRay Random(int samples, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<Real> uniform(0, 1);
    OneRay ray;
    for (int i = 0; i < samples; ++i) {
      const Real density = std::exp(6 * uniform(generator) - 3);
      const Real length = uniform(generator) / 10;
      ray.Add(density, length, uniform(generator), uniform(generator), uniform(generator));
    }
    return ray;
  }

  std::vector<std::int64_t> Begin() const { return {0, static_cast<std::int64_t>(Size())}; }

  Pixel Composite() const {
    const auto begin = Begin();
    Pixel pixel;
    kernels::CompositeForward<Real>({begin, sigma, dt, t, radiance, background},
                                    {pixel.rgb, {&pixel.opacity, 1}, {&pixel.depth, 1}}, 0, 1);
    return pixel;
  }

  std::vector<Real> Weights() const {
    const auto begin = Begin();
    std::vector<Real> weights(Size());
    kernels::WeightsForward<Real>(begin, sigma, dt, weights, 0, 1);
    return weights;
  }

  // The gradients of L = g_rgb . rgb + g_opacity opacity + g_depth depth.
  Gradients Backward(const std::vector<Real>& g_rgb, Real g_opacity = 0, Real g_depth = 0) const {
    const auto begin = Begin();
    Gradients out{std::vector<Real>(Size()), std::vector<Real>(3 * Size()), std::vector<Real>(3)};
    kernels::CompositeBackward<Real>({begin, sigma, dt, t, radiance, background},
                                     {g_rgb, {&g_opacity, 1}, {&g_depth, 1}},
                                     {out.sigma, out.radiance, out.background}, 0, 1);
    return out;
  }

  reference::Ray Oracle() const {
    reference::Ray ray;
    ray.sigma.assign(sigma.begin(), sigma.end());
    ray.dt.assign(dt.begin(), dt.end());
    ray.t.assign(t.begin(), t.end());
    ray.radiance.assign(radiance.begin(), radiance.end());
    for (int c = 0; c < 3; ++c) ray.background[c] = background[c];
    return ray;
  }
};

}  // namespace nerf
