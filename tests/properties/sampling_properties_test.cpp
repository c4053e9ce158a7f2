// Properties of all histograms, points and colours.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>

#include "nerf/image/srgb.h"
#include "nerf/kernels/histogram_loss.h"
#include "nerf/reference/ray_histogram.h"
#include "nerf/sampling/contraction.h"
#include "nerf/sampling/ray_intervals.h"
#include "tests/properties/properties.h"

namespace nerf {
namespace {

std::vector<float> RisingEdges(std::size_t intervals) {
  std::vector<float> edges = {*test::Fraction()};
  for (const float length : *test::VectorOf(intervals, test::Fraction())) {
    edges.push_back(edges.back() + length);
  }
  return edges;
}

RC_GTEST_PROP(AnyHistogram, IsResampledIntoIntervalsThatCoverItsRay, ()) {
  const auto intervals = *rc::gen::inRange<std::size_t>(1, 60);
  const auto edges = RisingEdges(intervals);
  const auto weights = *test::VectorOf(intervals, test::AnyLength());
  const float padding = *rc::gen::element(0.0f, 1e-6f, 0.01f, 1.0f), jitter = *test::Fraction();
  std::vector<float> out(*rc::gen::inRange<std::size_t>(2, 40));
  ResampleIntervals(edges, weights, padding, jitter, out);
  RC_ASSERT(std::ranges::is_sorted(out));
  RC_ASSERT(out.front() == edges.front());
  RC_ASSERT(out.back() == edges.back());
}

RC_GTEST_PROP(AnyHistogram, IsResampledWithAnnealedWeights, ()) {
  const auto intervals = *rc::gen::inRange<std::size_t>(1, 60);
  const auto edges = RisingEdges(intervals);
  const auto weights = *test::VectorOf(intervals, test::Fraction());
  std::vector<float> out(25);
  ResampleAnnealed(edges, weights, *test::Fraction(), 0.01f, *test::Fraction(), out);
  RC_ASSERT(std::ranges::is_sorted(out));
}

RC_GTEST_PROP(AnyHistogram, HasTheDistortionOfTheDoubleSum, ()) {
  const auto intervals = *rc::gen::inRange<std::size_t>(1, 40);
  const auto edges = RisingEdges(intervals);
  const auto weights = *test::VectorOf(intervals, test::Fraction());
  std::vector<float> gradient(intervals);
  const double loss = kernels::DistortionLoss<float>(edges, weights, gradient);
  const auto truth = static_cast<double>(reference::DistortionLoss(edges, weights));
  RC_ASSERT(std::fabs(loss - truth) <= 1e-5 * truth + 1e-12);
}

RC_GTEST_PROP(AnyPoint, ContractsIntoTheBallOfRadiusTwo, ()) {
  Eigen::Vector3f x;
  for (int i = 0; i < 3; ++i) {
    x[i] = *test::AnyLength() / 2 * *rc::gen::element(-1.0f, 1.0f);
  }
  const Eigen::Vector3f y = Contract(x);
  RC_ASSERT(y.allFinite());
  RC_ASSERT(y.norm() <= 2.0f + 1e-6f);
  for (int i = 0; i < 3; ++i) RC_ASSERT(y[i] * x[i] >= 0);  // never to the other side
}

RC_GTEST_PROP(AnyColour, KeepsItsOrderAndItsSignThroughSrgb, ()) {
  const float sign = *rc::gen::element(-1.0f, 1.0f);
  const float a = sign * *test::AnyLength(), b = sign * *test::AnyLength();
  RC_ASSERT(std::isfinite(SrgbFromLinear(a)));
  RC_ASSERT(SrgbFromLinear(a) * sign >= 0);
  if (a < b) RC_ASSERT(SrgbFromLinear(a) <= SrgbFromLinear(b));
}

}  // namespace
}  // namespace nerf
