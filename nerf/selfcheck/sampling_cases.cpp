// Sample placement: contraction of space, intervals of a ray, resampling, distortion loss.
#include <algorithm>
#include <cmath>
#include <random>

#include "nerf/kernels/histogram_loss.h"
#include "nerf/reference/contraction.h"
#include "nerf/reference/ray_histogram.h"
#include "nerf/sampling/contraction.h"
#include "nerf/sampling/occupancy_grid.h"
#include "nerf/sampling/ray_intervals.h"
#include "nerf/selfcheck/numeric_case.h"

namespace nerf {
namespace {

const Eigen::Vector3f kDirections[] = {
    {1, 0, 0}, {0, 0, -1}, {0.6f, 0.8f, 0}, Eigen::Vector3f(1, -2, 0.5f).normalized()};

reference::Vector3 Exact(const Eigen::Vector3f& x) { return {x[0], x[1], x[2]}; }

double ContractionIsAccurateFromZeroToFloatMax() {
  WorstError worst;
  for (const float r :
       {0.0f, 1e-30f, 0.5f, 0.99999994f, 1.0f, 1.0000001f, 2.0f, 1e3f, 1e19f, 1e30f, 2e38f}) {
    for (const Eigen::Vector3f& direction : kDirections) {
      const Eigen::Vector3f x = r * direction, y = Contract(x);
      const reference::Vector3 truth = reference::Contract(Exact(x));
      if (r < 0.9f) worst.Require(y == x);
      for (int i = 0; i < 3; ++i) worst.Add(std::fabs(static_cast<double>(y[i] - truth[i])));
    }
  }
  return worst.Get();
}

double ContractedSpeedIsTheDerivative() {
  WorstError worst;
  for (const float r : {0.0f, 1.0f, 1.0000001f, 1.5f, 30.0f, 1e8f}) {
    for (const Eigen::Vector3f& place : kDirections) {
      for (const Eigen::Vector3f& d : kDirections) {
        const float speed = ContractedSpeed(r * place, d);
        // In the radial direction the speed is a difference of terms as large as the tangential
        // speed, so errors are relative to that.
        worst.AddRelative(speed, reference::ContractedSpeed(Exact(r * place), Exact(d)),
                          1 / std::max(1.0f, r));
      }
    }
  }
  return worst.Get();
}

// Relative to the distance that one rounding of the contracted point stands for.
double UncontractInvertsContract() {
  WorstError worst;
  for (const float r : {0.1f, 0.99f, 1.0f, 1.01f, 3.0f, 50.0f, 1e3f}) {
    for (const Eigen::Vector3f& direction : kDirections) {
      const Eigen::Vector3f x = r * direction;
      worst.Add(
          static_cast<double>((Uncontract(Contract(x)) - x).norm() / (r * std::max(1.0f, r))));
    }
  }
  return worst.Get();
}

RayBatch OneRayFrom(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float jitter) {
  RayBatch rays;
  rays.Resize(1);
  std::copy_n(origin.data(), 3, rays.origin.begin());
  std::copy_n(direction.data(), 3, rays.direction.begin());
  rays.jitter[0] = jitter;
  return rays;
}

double IntervalsAscendFromNearToFar() {
  WorstError worst;
  for (const double near : {0.0, 1e-6, 0.05}) {
    for (const double far : {0.06, 1.0, 100.0, 1e8}) {
      MarchOptions options;
      options.near_distance = near;
      options.far_distance = far;
      for (const Eigen::Vector3f& origin :
           {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(0, 1, 0), Eigen::Vector3f(-40, 3, 0)}) {
        for (const Eigen::Vector3f& direction : kDirections) {
          for (const float jitter : {0.0f, 0.5f, 0.99999994f}) {
            std::vector<float> edges(41);
            EqualIntervals(OneRayFrom(origin, direction, jitter), 0, options, edges);
            worst.Require(edges.front() == static_cast<float>(near));
            worst.Require(edges.back() == static_cast<float>(far));
            for (std::size_t i = 1; i < edges.size(); ++i) {
              worst.Require(edges[i] > edges[i - 1] && std::isfinite(edges[i]));
            }
          }
        }
      }
      worst.Add(std::fabs(NormalizedDistance(static_cast<float>(near), options)));
      worst.Add(std::fabs(NormalizedDistance(static_cast<float>(far), options) - 1.0f));
    }
  }
  return worst.Get();
}

double MarchingEndsAndStaysOnItsRay() {
  WorstError worst;
  OccupancyOptions occupancy;
  occupancy.resolution = 16;
  for (const double far : {1.0, 100.0, 1e8}) {
    MarchOptions options;
    options.near_distance = 0;
    options.far_distance = far;
    const OccupancyGrid full(occupancy, options.StepLength());
    for (const Eigen::Vector3f& origin : {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(-1e4f, 3, 0)}) {
      for (const Eigen::Vector3f& direction : kDirections) {
        RaySamples samples;
        MarchRay(OneRayFrom(origin, direction, 0.25f), 0, full, options, samples);
        double length = 0;
        for (std::int64_t i = 0; i < samples.Size(); ++i) {
          worst.Require(samples.dt[i] > 0 && samples.t[i] >= 0 && samples.t[i] <= far);
          worst.Require(i == 0 || samples.t[i] > samples.t[i - 1]);
          length += static_cast<double>(samples.dt[i]);
        }
        worst.Require(samples.Size() < 5000);
        worst.AddRelative(length, far);  // a full grid leaves no gap
      }
    }
  }
  return worst.Get();
}

std::vector<float> EvenEdges(int intervals) {
  std::vector<float> edges(intervals + 1);
  for (int i = 0; i <= intervals; ++i) {
    edges[i] = 0.5f + 3.0f * static_cast<float>(i) / static_cast<float>(intervals);
  }
  return edges;
}

double ResamplingInvertsTheDistribution() {
  WorstError worst;
  std::mt19937 generator(2);
  std::exponential_distribution<float> exponential(1.0f);
  for (const int intervals : {1, 2, 40, 100000}) {
    const std::vector<float> edges = EvenEdges(intervals);
    std::vector<std::vector<float>> histograms(4, std::vector<float>(intervals));
    for (float& w : histograms[0]) w = exponential(generator);
    histograms[1].assign(intervals, 0.25f);  // constant
    histograms[2][intervals / 2] = 1.0f;     // a spike
    histograms[3].assign(intervals, 0.0f);   // no weight: resampled evenly
    for (const std::vector<float>& weights : histograms) {
      for (const float padding : {0.0f, 0.01f}) {
        for (const float jitter : {0.0f, 0.5f, 0.99999994f}) {
          constexpr int kSamples = 24;
          std::vector<float> out(kSamples + 1);
          ResampleIntervals(edges, weights, padding, jitter, out);
          const auto truth = reference::Resample(edges, weights, padding, jitter, kSamples);
          worst.Require(std::ranges::is_sorted(out));
          // The whole ray is covered: the ends of the distribution are exactly 0 and 1.
          worst.Require(out.front() == edges.front() && out.back() == edges.back());
          for (int m = 0; m <= kSamples; ++m) {
            worst.AddRelative(out[m], truth[m], 3);  // relative to the length of the ray
          }
        }
      }
    }
  }
  return worst.Get();
}

// The Kolmogorov-Smirnov statistic of positions drawn with random jitters, times the square root of
// their number: a correct sampler exceeds 1.95 once in a thousand draws. The seed is fixed.
double ResampledPositionsFollowTheWeights() {
  WorstError worst;
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  const std::vector<float> edges = {0, 1, 1.5f, 4, 4.25f, 8};
  const std::vector<float> weights = {1, 3, 0, 2, 0.5f};
  constexpr int kDraws = 4000;
  std::vector<float> positions;
  for (int i = 0; i < kDraws; ++i) {
    float halves[3];  // two intervals of equal weight; the jitter shifts the edge between them
    ResampleIntervals(edges, weights, 0.0f, uniform(generator), halves);
    positions.push_back(halves[1]);
  }
  std::ranges::sort(positions);
  for (int i = 0; i < kDraws; ++i) {
    double below = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const double length = static_cast<double>(edges[k + 1]) - static_cast<double>(edges[k]);
      const double inside = std::clamp(
          (static_cast<double>(positions[i]) - static_cast<double>(edges[k])) / length, 0.0, 1.0);
      below += static_cast<double>(weights[k]) * inside / 6.5;
    }
    // The edge is between a quarter and three quarters of the weight.
    worst.Add(std::fabs(2 * below - 0.5 - (i + 0.5) / kDraws) * std::sqrt(kDraws));
  }
  return worst.Get();
}

double DistortionLossMatchesTheDoubleSum() {
  WorstError worst;
  std::mt19937 generator(4);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (const float shift : {0.0f, 1.0f, 1000.0f}) {
    for (const int count : {1, 2, 64}) {
      std::vector<float> edges = {shift}, weights(count), gradient(count);
      for (float& w : weights) w = uniform(generator) / static_cast<float>(count);
      for (int i = 0; i < count; ++i)
        edges.push_back(edges.back() + 0.05f + 0.1f * uniform(generator));
      const double loss = kernels::DistortionLoss<float>(edges, weights, gradient);
      worst.AddRelative(loss, reference::DistortionLoss(edges, weights));
      for (int k = 0; k < count; ++k) {
        worst.AddRelative(gradient[k], reference::DistortionGradient(edges, weights, k));
      }
    }
  }
  return worst.Get();
}

}  // namespace

std::vector<NumericCase> SamplingCases() {
  return {
      {"ContractionIsAccurateFromZeroToFloatMax", "position", Within(5e-7, 1.8e-7), false,
       ContractionIsAccurateFromZeroToFloatMax},
      {"ContractedSpeedIsTheDerivative", "parts of the tangential speed", Within(6e-5, 6.9e-6),
       false, ContractedSpeedIsTheDerivative},
      {"UncontractInvertsContract", "position, parts of r max(1, r)", Within(1e-6, 4.0e-7), false,
       UncontractInvertsContract},
      {"IntervalsAscendFromNearToFar", "ends", kExact, false, IntervalsAscendFromNearToFar},
      {"MarchingEndsAndStaysOnItsRay", "length, relative", Within(4e-7, 1.8e-8), false,
       MarchingEndsAndStaysOnItsRay},
      {"ResamplingInvertsTheDistribution", "position, parts of the ray", Within(5e-7, 5.6e-8),
       false, ResamplingInvertsTheDistribution},
      {"ResampledPositionsFollowTheWeights", "Kolmogorov-Smirnov statistic", Within(1.95, 0.74),
       false, ResampledPositionsFollowTheWeights},
      {"DistortionLossMatchesTheDoubleSum", "loss, gradient, relative", Within(5e-7, 5.6e-8), false,
       DistortionLossMatchesTheDoubleSum},
  };
}

}  // namespace nerf
