// The gradient of the volume-rendering integral, where it is hard to compute.
#include <cmath>
#include <random>

#include "nerf/selfcheck/numeric_case.h"
#include "nerf/selfcheck/one_ray.h"

namespace nerf {
namespace {

using Ray = OneRay<float>;

double GradientsOfRandomRaysMatchTheOracle() {
  WorstError worst;
  const std::vector<float> g_rgb = {0.3f, -0.7f, 0.2f};
  const long double g[3] = {g_rgb[0], g_rgb[1], g_rgb[2]};
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Ray ray = OneRay<float>::Random(48, seed);
    const auto gradients = ray.Backward(g_rgb, 0.4f, -0.1f);
    const auto truth = reference::GradientOfSigma(ray.Oracle(), g, 0.4f, -0.1f);
    const auto T_end = reference::TransmittanceBefore(ray.Oracle(), ray.Size());
    for (std::size_t i = 0; i < ray.Size(); ++i) {
      worst.AddRelative(gradients.sigma[i], truth[i], 1e-6L);
      const long double weight = reference::Weight(ray.Oracle(), i);
      for (int c = 0; c < 3; ++c) {
        worst.AddRelative(gradients.radiance[3 * i + c], weight * g[c], 1e-24L);
      }
    }
    for (int c = 0; c < 3; ++c) worst.AddRelative(gradients.background[c], T_end * g[c], 1e-24L);
  }
  return worst.Get();
}

double EmptySpaceHasAGradient() {
  WorstError worst;
  Ray ray;
  for (int i = 0; i < 8; ++i) ray.Add(0.0f, 0.1f);
  for (const float g : ray.Backward(kRed).sigma) {
    worst.AddRelative(g, 0.1f * (0.5L - static_cast<long double>(0.2f)));  // dt (c - b)
  }
  return worst.Get();
}

// dC/dalpha_k = dC/dx_k e^{x_k} = T_k (c_k - C_behind), where e^{-x_k} nearly vanishes.
double AnOpaqueSampleHasAGradient() {
  WorstError worst;
  for (const float x : {1.0f, 10.0f, 20.0f, 40.0f, 80.0f}) {
    Ray ray;
    ray.Add(0.5f, 1.0f);
    ray.Add(x, 1.0f, 0.9f);
    ray.Add(2.0f, 1.0f, 0.1f);
    const double T_k = std::exp(-0.5), T_behind = std::exp(-2.0);
    const double behind = 0.1 * (1 - T_behind) + 0.2 * T_behind;
    const double of_alpha =
        static_cast<double>(ray.Backward(kRed).sigma[1]) * std::exp(static_cast<double>(x));
    worst.AddRelative(of_alpha, T_k * (0.9 - behind));
  }
  return worst.Get();
}

double GradientsDeepInTheRayKeepTheirSign() {
  WorstError worst;
  Ray ray;
  for (int i = 0; i < 40; ++i) ray.Add(4.0f, 0.1f, i % 3 == 0 ? 0.9f : 0.1f);
  const long double g[3] = {1, 0, 0};
  const auto truth = reference::GradientOfSigma(ray.Oracle(), g, 0, 0);
  const auto gradients = ray.Backward(kRed);
  worst.Require(reference::TransmittanceBefore(ray.Oracle(), 38) < 1e-5L);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    worst.AddRelative(gradients.sigma[i], truth[i]);
  }
  return worst.Get();
}

double GradientsMatchCentralDifferences() {
  WorstError worst;
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  OneRay<double> ray;
  for (int i = 0; i < 12; ++i) {
    ray.Add(3 * uniform(generator), 0.3 * uniform(generator), uniform(generator),
            uniform(generator), uniform(generator));
  }
  const std::vector<double> g = {0.3, -0.7, 0.2};
  const auto loss = [&] {
    const auto pixel = ray.Composite();
    return g[0] * pixel.rgb[0] + g[1] * pixel.rgb[1] + g[2] * pixel.rgb[2] + 0.4 * pixel.opacity -
           0.1 * pixel.depth;
  };
  const auto gradients = ray.Backward(g, 0.4, -0.1);
  const auto compare = [&](std::vector<double>& inputs, const std::vector<double>& gradient) {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const double at = inputs[i], h = 1e-5;
      inputs[i] = at + h;
      const double above = loss();
      inputs[i] = at - h;
      const double below = loss();
      inputs[i] = at;
      worst.AddRelative(gradient[i], (above - below) / (2 * h), 1e-2L);
    }
  };
  compare(ray.sigma, gradients.sigma);
  compare(ray.radiance, gradients.radiance);
  compare(ray.background, gradients.background);
  return worst.Get();
}

}  // namespace

std::vector<NumericCase> CompositingGradientCases() {
  const std::string relative = "relative to long double";
  return {
      {"GradientsOfRandomRaysMatchTheOracle", relative, Within(5e-7, 5.9e-8), false,
       GradientsOfRandomRaysMatchTheOracle},
      {"EmptySpaceHasAGradient", "gradient, relative", Within(4e-7, 2.7e-8), false,
       EmptySpaceHasAGradient},
      {"AnOpaqueSampleHasAGradient", "gradient, relative", Within(6e-7, 6.3e-8), false,
       AnOpaqueSampleHasAGradient},
      {"GradientsDeepInTheRayKeepTheirSign", "gradient, relative", Within(5e-7, 5.7e-8), false,
       GradientsDeepInTheRayKeepTheirSign},
      {"GradientsMatchCentralDifferences", relative, Within(6e-9, 6.2e-10, kDoubleRounding), false,
       GradientsMatchCentralDifferences},
  };
}

}  // namespace nerf
