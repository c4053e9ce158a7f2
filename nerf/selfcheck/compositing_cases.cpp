// The volume-rendering integral and its gradient, where they are hard to compute.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "nerf/kernels/flush_denormals.h"
#include "nerf/selfcheck/numeric_case.h"
#include "nerf/selfcheck/one_ray.h"

namespace nerf {
namespace {

using Ray = OneRay<float>;

const std::vector<float> kAll = {1, 1, 1};

long double OpticalDepth(const Ray& ray) {
  long double tau = 0;
  for (std::size_t i = 0; i < ray.Size(); ++i) {
    tau += static_cast<long double>(ray.sigma[i]) * static_cast<long double>(ray.dt[i]);
  }
  return tau;
}

double RandomRaysMatchTheOracle() {
  WorstError worst;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Ray ray = OneRay<float>::Random(64, seed);
    const auto pixel = ray.Composite();
    const reference::Pixel truth = reference::Composite(ray.Oracle());
    for (int c = 0; c < 3; ++c) worst.AddRelative(pixel.rgb[c], truth.rgb[c]);
    worst.AddRelative(pixel.opacity, truth.opacity);
    worst.AddRelative(pixel.depth, truth.depth);
  }
  return worst.Get();
}

double EmptySpaceShowsTheBackground() {
  WorstError worst;
  Ray ray;
  for (int i = 0; i < 8; ++i) ray.Add(0.0f, 0.1f);
  for (const Ray& empty : {ray, Ray()}) {
    const auto pixel = empty.Composite();
    for (int c = 0; c < 3; ++c) worst.Add(std::fabs(pixel.rgb[c] - empty.background[c]));
    worst.Add(pixel.opacity);
    worst.Add(pixel.depth);
  }
  return worst.Get();
}

double ThinFogKeepsItsOpacity() {
  WorstError worst;
  for (const double tau : {1e-6, 1e-5, 1e-4, 1e-3}) {
    Ray ray;
    for (int i = 0; i < 1024; ++i) ray.Add(static_cast<float>(tau / 1024 / 0.01), 0.01f);
    worst.AddRelative(ray.Composite().opacity, -std::expm1(-OpticalDepth(ray)));
  }
  return worst.Get();
}

double AnOpaqueIntervalTakesAllTheWeight() {
  WorstError worst;
  Ray ray;
  ray.Add(0.0f, 0.1f);
  ray.Add(1e10f, 1.0f, 1.0f, 0.0f, 0.0f);
  ray.Add(3.0f, 0.1f);
  const auto weights = ray.Weights();
  for (int i = 0; i < 3; ++i) worst.Add(std::fabs(weights[i] - (i == 1 ? 1.0f : 0.0f)));
  const auto gradients = ray.Backward(kAll, 1, 1);
  for (const float g : gradients.sigma) worst.RequireFinite(g);
  for (const float g : gradients.radiance) worst.RequireFinite(g);
  worst.Require(gradients.sigma[0] != 0 && gradients.sigma[2] == 0);
  return worst.Get();
}

double ExtremeDensitiesAndLengthsStayFinite() {
  WorstError worst;
  const float extremes[] = {0.0f, 1e-10f, 1.0f, 1e10f, 1e30f};
  for (const float sigma : extremes) {
    for (const float length : extremes) {
      Ray ray;
      ray.Add(sigma, length);
      ray.Add(1.0f, 0.1f);
      const auto pixel = ray.Composite();
      for (const float value : pixel.rgb) worst.RequireFinite(value);
      worst.RequireFinite(pixel.opacity);
      worst.RequireFinite(pixel.depth);
      const auto gradients = ray.Backward(kAll, 1);
      for (const float g : gradients.sigma) worst.RequireFinite(g);
      for (const float g : gradients.radiance) worst.RequireFinite(g);
    }
  }
  return worst.Get();
}

double InfiniteDensityOverNoLengthIsEmpty() {
  WorstError worst;
  Ray ray;
  ray.Add(kInfinity, 0.0f);
  worst.Add(ray.Composite().opacity);
  worst.Add(ray.Weights()[0]);
  worst.Add(std::fabs(ray.Backward(kAll, 1, 1).sigma[0]));
  return worst.Get();
}

double WeightsAreRightForEveryOpticalDepth() {
  WorstError worst;
  for (int k = -24; k <= 5; ++k) {
    for (int repeats = 1; repeats <= 3; ++repeats) {
      Ray ray;
      for (int i = 0; i < repeats; ++i) ray.Add(std::ldexp(1.0f, k), 1.0f);
      const auto weights = ray.Weights();
      for (std::size_t i = 0; i < ray.Size(); ++i) {
        // The floor is about the smallest normal float: below it, 0 is right as well.
        worst.AddRelative(weights[i], reference::Weight(ray.Oracle(), i), 1e-33L);
      }
    }
  }
  return worst.Get();
}

double WeightsAndTransmittanceSumToOne() {
  WorstError worst;
  for (unsigned seed = 0; seed < 50; ++seed) {
    Ray ray = OneRay<float>::Random(256, seed);
    std::fill(ray.radiance.begin(), ray.radiance.end(), 1.0f);
    std::fill(ray.background.begin(), ray.background.end(), 1.0f);
    worst.Add(std::fabs(static_cast<double>(ray.Composite().rgb[0]) - 1.0));
    double sum = 0;
    for (const float w : ray.Weights()) sum += static_cast<double>(w);
    const auto T_end = reference::TransmittanceBefore(ray.Oracle(), ray.Size());
    worst.Add(std::fabs(sum + static_cast<double>(T_end) - 1.0));
  }
  return worst.Get();
}

double SplittingAnIntervalChangesNothing() {
  WorstError worst;
  for (const float sigma : {1e-6f, 0.1f, 3.0f, 100.0f}) {
    Ray whole, split;
    whole.Add(sigma, 0.5f);
    split.Add(sigma, 0.25f);
    split.Add(sigma, 0.25f);
    const auto a = whole.Composite(), b = split.Composite();
    for (int c = 0; c < 3; ++c) worst.AddRelative(b.rgb[c], a.rgb[c]);
    worst.AddRelative(b.opacity, a.opacity);
  }
  return worst.Get();
}

double AHomogeneousSlabFollowsBeerAndLambert() {
  WorstError worst;
  constexpr int kSteps = 4096;
  constexpr float kLength = 2.0f, kSigma = 1.7f;
  OneRay<double> ray;
  for (int i = 0; i < kSteps; ++i) ray.Add(double{kSigma}, double{kLength} / kSteps);
  const double T = std::exp(-double{kSigma} * double{kLength});
  const auto pixel = ray.Composite();
  worst.AddRelative(pixel.rgb[0], 0.5 * (1 - T) + 0.2 * T);
  // The mean of t under sigma e^{-sigma (t-1)} on [1, 1 + L], times the opacity. Samples are at the
  // centres of their steps, which is accurate to second order.
  worst.AddRelative(pixel.depth, (1 - T) * (1 + 1 / double{kSigma}) - double{kLength} * T);
  return worst.Get();
}

double TheUnitOfLengthDoesNotMatter() {
  WorstError worst;
  for (const float scale : {1e-3f, 0.5f, 1e4f}) {
    Ray ray = OneRay<float>::Random(64, 5), scaled = ray;
    for (std::size_t i = 0; i < ray.Size(); ++i) {
      scaled.sigma[i] /= scale;
      scaled.dt[i] *= scale;
      scaled.t[i] *= scale;
    }
    const auto a = ray.Composite(), b = scaled.Composite();
    for (int c = 0; c < 3; ++c) worst.AddRelative(b.rgb[c], a.rgb[c]);
    worst.AddRelative(b.depth, a.depth * scale);
  }
  return worst.Get();
}

double FlushingDenormalsChangesNothing() {
  WorstError worst;
  const auto results = [](const Ray& ray) {
    return std::pair(ray.Composite(), ray.Backward(kAll, 1, 1).sigma);
  };
  const auto flushed_results = [&results](const Ray& ray) {
    const kernels::FlushDenormals flush;
    return results(ray);
  };
  for (const float tau : {80.0f, 87.0f, 95.0f, 102.0f, 110.0f}) {
    Ray ray;
    ray.Add(tau, 1.0f);
    ray.Add(1.0f, 1.0f);
    const auto [pixel, gradient] = results(ray);
    const auto [flushed_pixel, flushed_gradient] = flushed_results(ray);
    for (int c = 0; c < 3; ++c) worst.Add(std::fabs(pixel.rgb[c] - flushed_pixel.rgb[c]));
    worst.Add(std::fabs(pixel.opacity - flushed_pixel.opacity));
    for (std::size_t i = 0; i < ray.Size(); ++i) {
      worst.Add(std::fabs(gradient[i] - flushed_gradient[i]));
    }
  }
  return worst.Get();
}

double EarlyTerminationKeepsTheBackground() {
  WorstError worst;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Ray ray = OneRay<float>::Random(200, seed);
    for (const double stop : {1e-1, 1e-2, 1e-4}) {
      const auto begin = ray.Begin();
      std::vector<std::int64_t> kept(1);
      kernels::CountVisible<float>(begin, ray.sigma, ray.dt, stop, kept, 0, 1);
      Ray front = ray;
      for (auto* values : {&front.sigma, &front.dt, &front.t}) values->resize(kept[0]);
      front.radiance.resize(3 * kept[0]);
      worst.Require(stop < 0.1 || front.Size() < ray.Size());  // samples are skipped
      const auto whole = ray.Composite(), stopped = front.Composite();
      // No colour is above 1, so the pixel changes by at most the remaining transmittance.
      for (int c = 0; c < 3; ++c) worst.Add(std::fabs(whole.rgb[c] - stopped.rgb[c]) / stop);
    }
  }
  return worst.Get();
}

double ZeroLengthIntervalsHaveNoEffect() {
  WorstError worst;
  Ray with, without;
  for (int i = 0; i < 6; ++i) {
    with.Add(2.0f, 0.1f);
    without.Add(2.0f, 0.1f);
    with.Add(5.0f, 0.0f, 9.0f, 9.0f, 9.0f);
  }
  const auto a = with.Composite(), b = without.Composite();
  for (int c = 0; c < 3; ++c) worst.Add(std::fabs(a.rgb[c] - b.rgb[c]));
  const auto gradients = with.Backward(kAll, 1, 1);
  for (std::size_t i = 1; i < with.Size(); i += 2) {
    worst.Add(std::fabs(gradients.sigma[i]));
    worst.Add(with.Weights()[i]);
  }
  return worst.Get();
}

}  // namespace

std::vector<NumericCase> CompositingCases() {
  const std::string relative = "relative to long double";
  return {
      {"RandomRaysMatchTheOracle", relative, Within(5e-7, 5.7e-8), false, RandomRaysMatchTheOracle},
      {"EmptySpaceShowsTheBackground", "colour", kExact, false, EmptySpaceShowsTheBackground},
      {"ThinFogKeepsItsOpacity", "opacity, relative", Within(4e-7, 3.8e-8), false,
       ThinFogKeepsItsOpacity},
      {"AnOpaqueIntervalTakesAllTheWeight", "weight", kExact, false,
       AnOpaqueIntervalTakesAllTheWeight},
      {"ExtremeDensitiesAndLengthsStayFinite", "finite or not", kExact, false,
       ExtremeDensitiesAndLengthsStayFinite},
      {"InfiniteDensityOverNoLengthIsEmpty", "opacity, gradient", kExact, false,
       InfiniteDensityOverNoLengthIsEmpty},
      {"WeightsAreRightForEveryOpticalDepth", relative, Within(4e-7, 3.9e-8), false,
       WeightsAreRightForEveryOpticalDepth},
      {"WeightsAndTransmittanceSumToOne", "sum", Within(4e-7, 3.0e-8), false,
       WeightsAndTransmittanceSumToOne},
      {"SplittingAnIntervalChangesNothing", "colour, relative", Within(4e-7, 0), false,
       SplittingAnIntervalChangesNothing},
      {"AHomogeneousSlabFollowsBeerAndLambert", "colour, depth, relative", Within(2e-7, 2.2e-8),
       false, AHomogeneousSlabFollowsBeerAndLambert},
      {"TheUnitOfLengthDoesNotMatter", "colour, depth, relative", Within(7e-7, 7.5e-8), false,
       TheUnitOfLengthDoesNotMatter},
      {"FlushingDenormalsChangesNothing", "with flush-to-zero against without",
       Within(4e-38, 6.5e-39, std::numeric_limits<float>::min()), false,
       FlushingDenormalsChangesNothing},
      {"EarlyTerminationKeepsTheBackground", "colour, parts of the transmittance left",
       Within(1, 0.7), false, EarlyTerminationKeepsTheBackground},
      {"ZeroLengthIntervalsHaveNoEffect", "colour, gradient", kExact, false,
       ZeroLengthIntervalsHaveNoEffect},
  };
}

}  // namespace nerf
