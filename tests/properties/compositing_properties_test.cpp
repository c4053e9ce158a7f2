// Properties of all rays, tested on random ones of all magnitudes.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "nerf/selfcheck/one_ray.h"
#include "tests/properties/properties.h"

namespace nerf {
namespace {

using Ray = OneRay<float>;

Ray AnyRay() {
  const auto samples = *rc::gen::inRange<std::size_t>(0, 40);
  const auto sigma = *test::VectorOf(samples, test::AnyLength());
  const auto dt = *test::VectorOf(samples, test::AnyLength());
  const auto rgb = *test::VectorOf(3 * samples + 3, test::Fraction());
  Ray ray;
  for (std::size_t i = 0; i < samples; ++i) {
    ray.Add(sigma[i], dt[i], rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]);
    // Not summed up: positions behind lengths of 1e30 exceed the precision of float.
    ray.t.back() = static_cast<float>(i);
  }
  ray.background.assign(rgb.end() - 3, rgb.end());
  return ray;
}

RC_GTEST_PROP(AnyRay, IsAMixtureOfItsColoursAndItsBackground, ()) {
  const Ray ray = AnyRay();
  const auto pixel = ray.Composite();
  RC_ASSERT(pixel.opacity >= 0 && pixel.opacity <= 1);
  for (int c = 0; c < 3; ++c) {
    float low = ray.background[c], high = ray.background[c];
    for (std::size_t i = 0; i < ray.Size(); ++i) {
      low = std::min(low, ray.radiance[3 * i + c]);
      high = std::max(high, ray.radiance[3 * i + c]);
    }
    RC_ASSERT(pixel.rgb[c] >= low - 1e-6f && pixel.rgb[c] <= high + 1e-6f);
  }
}

RC_GTEST_PROP(AnyRay, HasWeightsThatSumToItsOpacity, ()) {
  const Ray ray = AnyRay();
  double sum = 0;
  for (const float w : ray.Weights()) {
    RC_ASSERT(w >= 0 && w <= 1);
    sum += static_cast<double>(w);
  }
  RC_ASSERT(std::fabs(sum - static_cast<double>(ray.Composite().opacity)) < 1e-5);
}

RC_GTEST_PROP(AnyRay, MatchesTheOracle, ()) {
  const Ray ray = AnyRay();
  const auto pixel = ray.Composite();
  const reference::Pixel truth = reference::Composite(ray.Oracle());
  for (int c = 0; c < 3; ++c) {
    RC_ASSERT(std::fabs(pixel.rgb[c] - truth.rgb[c]) <= 1e-6L);
  }
  RC_ASSERT(std::fabs(pixel.opacity - truth.opacity) <= 1e-6L * truth.opacity + 1e-37L);
}

RC_GTEST_PROP(AnyRay, IsTheSameWhereAnIntervalIsSplit, ()) {
  const Ray ray = AnyRay();
  RC_PRE(ray.Size() > 0);
  const auto at = *rc::gen::inRange<std::size_t>(0, ray.Size());
  Ray split;
  split.background = ray.background;
  for (std::size_t i = 0; i < ray.Size(); ++i) {
    for (int part = 0; part < (i == at ? 2 : 1); ++part) {
      split.Add(ray.sigma[i], i == at ? ray.dt[i] / 2 : ray.dt[i], ray.radiance[3 * i],
                ray.radiance[3 * i + 1], ray.radiance[3 * i + 2]);
      split.t.back() = ray.t[i];
    }
  }
  RC_PRE(ray.dt[at] == 0 || ray.dt[at] > 1e-37f);  // half of a denormal is not half
  const auto a = ray.Composite(), b = split.Composite();
  for (int c = 0; c < 3; ++c) RC_ASSERT(std::fabs(a.rgb[c] - b.rgb[c]) <= 1e-6f);
  RC_ASSERT(std::fabs(a.opacity - b.opacity) <= 1e-6f * a.opacity);
}

RC_GTEST_PROP(AnyRay, HasFiniteGradients, ()) {
  const Ray ray = AnyRay();
  const auto gradients = ray.Backward({1.0f, -0.5f, 0.25f}, 0.5f);
  for (std::size_t i = 0; i < ray.Size(); ++i) {
    // dL/dsigma has the factor dt, so only the gradient by the optical depth is finite.
    if (ray.dt[i] <= 1e30f) RC_ASSERT(std::isfinite(gradients.sigma[i]));
    for (int c = 0; c < 3; ++c) RC_ASSERT(std::fabs(gradients.radiance[3 * i + c]) <= 1.0f);
  }
  for (const float g : gradients.background) RC_ASSERT(std::isfinite(g));
}

RC_GTEST_PROP(AnyRay, ChangesByLessThanTheTransmittanceOnEarlyTermination, ()) {
  Ray ray = AnyRay();
  const double stop = std::ldexp(1.0, -*rc::gen::inRange(1, 30));
  const auto begin = ray.Begin();
  std::vector<std::int64_t> kept(1);
  kernels::CountVisible<float>(begin, ray.sigma, ray.dt, stop, kept, 0, 1);
  const auto whole = ray.Composite();
  for (auto* values : {&ray.sigma, &ray.dt, &ray.t}) values->resize(kept[0]);
  ray.radiance.resize(3 * kept[0]);
  const auto stopped = ray.Composite();
  for (int c = 0; c < 3; ++c) {
    RC_ASSERT(std::fabs(static_cast<double>(whole.rgb[c] - stopped.rgb[c])) <= stop + 1e-6);
  }
}

}  // namespace
}  // namespace nerf
