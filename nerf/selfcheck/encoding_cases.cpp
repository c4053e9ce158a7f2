// Encodings of position and direction, and the activations of the networks' outputs.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "nerf/kernels/activations.h"
#include "nerf/kernels/direction_encoding.h"
#include "nerf/kernels/hash_encoding_tile.h"
#include "nerf/reference/hash_encoding.h"
#include "nerf/selfcheck/numeric_case.h"
#include "nerf/selfcheck/one_ray.h"

namespace nerf {
namespace {

using kernels::HashGridLayout;

// Two dense levels and four hashed ones.
HashGridLayout SmallGrid(int features) {
  return kernels::MakeHashGridLayout({6, features, 10, 4, 128});
}

std::vector<float> RandomFloats(std::size_t count, unsigned seed, float low, float high) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(low, high);
  std::vector<float> values(count);
  for (float& v : values) v = uniform(generator);
  return values;
}

// Corners and faces of the cube, both sides of cell borders, and random positions.
std::vector<float> HardPositions() {
  std::vector<float> positions = RandomFloats(3 * 50, 8, 0.0f, 1.0f);
  const float next = std::nextafter(0.5f, 1.0f), before = std::nextafter(0.5f, 0.0f);
  for (const float u : {0.0f, 1e-30f, 0.25f, before, 0.5f, next, 0.99999994f, 1.0f}) {
    positions.insert(positions.end(), {u, u, u, u, 0.3f, 1.0f, 0.0f, u, 0.7f, 1.0f, 0.0f, u});
  }
  return positions;
}

std::vector<float> EncodeTile(const HashGridLayout& layout, const std::vector<float>& table,
                              const std::vector<float>& positions) {
  const auto count = static_cast<std::int64_t>(positions.size() / 3);
  const std::vector<float> all(layout.levels.size(), 1.0f);
  std::vector<float> encoded(count * layout.OutputSize());
  kernels::HashEncodeTile(layout, table.data(), positions.data(), count, all, encoded.data(),
                          layout.OutputSize());
  return encoded;
}

double HashEncodingInterpolatesUpToTheLastCorner() {
  WorstError worst;
  for (const int features : {1, 2, 4, 8}) {
    const HashGridLayout layout = SmallGrid(features);
    const auto table = RandomFloats(layout.entries * features, 6, -1.0f, 1.0f);
    const std::vector<double> exact_table(table.begin(), table.end());
    const auto positions = HardPositions();
    const auto encoded = EncodeTile(layout, table, positions);
    for (std::size_t i = 0; i < positions.size() / 3; ++i) {
      const auto truth = reference::HashEncode(
          layout, exact_table, {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]});
      for (std::size_t k = 0; k < truth.size(); ++k) {
        worst.Add(std::fabs(static_cast<double>(encoded[i * truth.size() + k]) - truth[k]));
      }
    }
  }
  return worst.Get();
}

double HashEncodingWeightsSumToOne() {
  WorstError worst;
  const HashGridLayout layout = SmallGrid(4);
  const std::vector<float> ones(layout.entries * 4, 1.0f);
  for (const float e : EncodeTile(layout, ones, HardPositions())) worst.Add(std::fabs(e - 1.0f));
  return worst.Get();
}

// <dL/dencoded, encode(table)> is linear in the table, so its gradient is the adjoint. It reaches
// the eight corners of the cell and nothing else.
double HashGradientsReachTheCornersOfTheCell() {
  WorstError worst;
  for (const int features : {1, 2, 4, 8}) {
    const HashGridLayout layout = SmallGrid(features);
    const auto table = RandomFloats(layout.entries * features, 6, -1.0f, 1.0f);
    const auto positions = HardPositions();
    const auto count = static_cast<std::int64_t>(positions.size() / 3);
    const auto encoded = EncodeTile(layout, table, positions);
    const auto dL_dencoded = RandomFloats(encoded.size(), 7, -1.0f, 1.0f);
    std::vector<float> dL_dtable(table.size(), 0.0f);
    for (int l = 0; l < static_cast<int>(layout.levels.size()); ++l) {
      kernels::HashScatterLevel(layout, l, 1.0f, positions.data(), dL_dencoded.data(),
                                layout.OutputSize(), count, dL_dtable.data());
    }
    double forward = 0, backward = 0, size = 0;
    for (std::size_t i = 0; i < encoded.size(); ++i) {
      const double product = static_cast<double>(encoded[i]) * static_cast<double>(dL_dencoded[i]);
      forward += product;
      size += std::fabs(product);
    }
    for (std::size_t i = 0; i < table.size(); ++i) {
      backward += static_cast<double>(table[i]) * static_cast<double>(dL_dtable[i]);
    }
    worst.Add(std::fabs(forward - backward) / size);

    std::vector<float> of_one(table.size(), 0.0f);
    const float inside[3] = {0.6f, 0.6f, 0.6f};
    kernels::HashScatterLevel(layout, 0, 1.0f, inside, dL_dencoded.data(), layout.OutputSize(), 1,
                              of_one.data());
    int touched = 0;
    for (std::size_t e = 0; e < of_one.size(); e += features) touched += of_one[e] != 0;
    worst.Require(touched == 8);
  }
  return worst.Get();
}

// The gradient of <dL/dencoded, encode(position)> in the position against central differences in
// double, with levels of reduced and of zero weight. Inside cells, since the encoding is not
// differentiable at their faces.
double HashPositionGradientsMatchDifferences() {
  WorstError worst;
  constexpr double kStep = 1e-7;
  const std::vector<float> level_weight = {1.0f, 0.5f, 1.0f, 0.25f, 0.0f, 1.0f};
  for (const int features : {1, 2, 4, 8}) {
    const HashGridLayout layout = SmallGrid(features);
    const auto table = RandomFloats(layout.entries * features, 6, -1.0f, 1.0f);
    const std::vector<double> exact_table(table.begin(), table.end());
    const auto positions = RandomFloats(3 * 50, 8, 0.01f, 0.99f);
    const auto dL_dencoded = RandomFloats(50 * layout.OutputSize(), 7, -1.0f, 1.0f);
    std::vector<float> gradient(positions.size(), 0.0f);
    kernels::HashEncodePositionBackward<float>(layout, table, positions, dL_dencoded,
                                               layout.OutputSize(), level_weight, gradient, 0, 50);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      std::array<double, 3> x{};
      std::copy_n(positions.begin() + 3 * (i / 3), 3, x.begin());
      std::array<double, 3> above = x, below = x;
      above[i % 3] += kStep;
      below[i % 3] -= kStep;
      const auto high = reference::HashEncode(layout, exact_table, above);
      const auto low = reference::HashEncode(layout, exact_table, below);
      double truth = 0;
      for (std::size_t k = 0; k < high.size(); ++k) {
        truth += static_cast<double>(dL_dencoded[i / 3 * high.size() + k]) *
                 static_cast<double>(level_weight[k / features]) * (high[k] - low[k]) / (2 * kStep);
      }
      worst.Add((static_cast<double>(gradient[i]) - truth) / (1 + std::fabs(truth)));
    }
  }
  return worst.Get();
}

double DensityOfAnyNetworkOutputIsFinite() {
  WorstError worst;
  std::vector<float> x;
  for (const float size :
       {0.0f, 1e-40f, 1.0f, 14.0f, 15.0f, 16.0f, 88.0f, 200.0f, 1e4f, 3e38f, kInfinity}) {
    x.push_back(size);
    x.insert(x.begin(), -size);
  }
  auto sigma = x;
  kernels::TruncatedExp(sigma, 0.0f, 15.0f);
  for (std::size_t i = 0; i < x.size(); ++i) {
    worst.Require(i == 0 || sigma[i] >= sigma[i - 1]);  // increasing in x
    worst.AddRelative(sigma[i], std::exp(std::clamp(static_cast<double>(x[i]), -15.0, 15.0)));
  }
  std::vector<float> nan(17, std::numeric_limits<float>::quiet_NaN());
  kernels::TruncatedExp(nan, 0.0f, 15.0f);
  for (const float y : nan) worst.Require(std::isnan(y));  // a hidden NaN would never be reported
  return worst.Get();
}

double ColourOfAnyNetworkOutputIsInRange() {
  WorstError worst;
  std::vector<float> x = {kInfinity, -kInfinity, 3e38f, -3e38f, 1e-40f, 0.0f, -0.0f};
  for (float v = -40.0f; v <= 40.0f; v += 0.37f) x.push_back(v);
  auto y = x;
  kernels::Sigmoid(y);
  for (std::size_t i = 0; i < x.size(); ++i) {
    worst.Require(y[i] >= 0 && y[i] <= 1);
    worst.AddRelative(y[i], 1.0 / (1.0 + std::exp(-static_cast<double>(x[i]))), 1e-27L);
  }
  std::vector<float> nan(17, std::numeric_limits<float>::quiet_NaN());
  kernels::Sigmoid(nan);
  for (const float v : nan) worst.Require(std::isnan(v));
  return worst.Get();
}

// A density so thin that 1 - exp(-x) would be 0 in float, through activation and integral.
double TinyOpacitiesAreNotCancelled() {
  WorstError worst;
  for (const float x : {-5.0f, -10.0f, -14.9f}) {
    std::vector<float> sigma(16, x);
    kernels::TruncatedExp(sigma, 0.0f, 15.0f);
    OneRay<float> ray;
    ray.Add(sigma[0], 1e-3f);
    const double depth = std::exp(static_cast<double>(x)) * static_cast<double>(ray.dt[0]);
    worst.AddRelative(ray.Composite().opacity, -std::expm1(-depth));
    worst.AddRelative(ray.Weights()[0], -std::expm1(-depth));
  }
  return worst.Get();
}

// The real spherical harmonic of degree l and order m, from associated Legendre polynomials.
double Harmonic(int l, int m, double theta, double phi) {
  const int k = std::abs(m);
  double factorials = 1;
  for (int i = l - k + 1; i <= l + k; ++i) factorials *= i;
  const double norm = std::sqrt((2 * l + 1) / (4 * std::numbers::pi) / factorials);
  // std::assoc_legendre omits the factor (-1)^m that Sloan's table includes.
  const double p = std::assoc_legendre(l, k, std::cos(theta)) * (k % 2 == 0 ? 1 : -1);
  if (m == 0) return norm * p;
  return std::numbers::sqrt2 * norm * p * (m > 0 ? std::cos(k * phi) : std::sin(k * phi));
}

double DirectionsAreHarmonicsUpToThePoles() {
  WorstError worst;
  for (const double theta : {0.0, 1e-7, 0.3, 1.2, 2.9, std::numbers::pi - 1e-7, std::numbers::pi}) {
    for (const double phi : {0.0, 0.7, 2.0, 4.0, 6.2}) {
      const float direction[3] = {static_cast<float>(std::sin(theta) * std::cos(phi)),
                                  static_cast<float>(std::sin(theta) * std::sin(phi)),
                                  static_cast<float>(std::cos(theta))};
      float encoded[kernels::kDirectionFeatures];
      kernels::EncodeDirection(direction, encoded);
      for (int l = 0, i = 0; l <= 3; ++l) {
        for (int m = -l; m <= l; ++m, ++i) {
          worst.Add(std::fabs(static_cast<double>(encoded[i]) - Harmonic(l, m, theta, phi)));
        }
      }
    }
  }
  return worst.Get();
}

}  // namespace

std::vector<NumericCase> EncodingCases() {
  return {
      {"HashEncodingInterpolatesUpToTheLastCorner", "feature, table in [-1,1]",
       Within(1e-6, 1.5e-7), true, HashEncodingInterpolatesUpToTheLastCorner},
      {"HashEncodingWeightsSumToOne", "sum of weights", Within(1e-6, 1.2e-7), true,
       HashEncodingWeightsSumToOne},
      {"HashGradientsReachTheCornersOfTheCell", "adjoint, relative", Within(4e-7, 3.3e-9), true,
       HashGradientsReachTheCornersOfTheCell},
      {"HashPositionGradientsMatchDifferences", "gradient, relative", Within(5e-5, 6.0e-6), false,
       HashPositionGradientsMatchDifferences},
      {"DensityOfAnyNetworkOutputIsFinite", "relative", Within(4e-7, 3.9e-8), true,
       DensityOfAnyNetworkOutputIsFinite},
      {"ColourOfAnyNetworkOutputIsInRange", "relative", Within(5e-7, 8.8e-8), true,
       ColourOfAnyNetworkOutputIsInRange},
      {"TinyOpacitiesAreNotCancelled", "opacity, relative", Within(4e-7, 4.0e-8), true,
       TinyOpacitiesAreNotCancelled},
      {"DirectionsAreHarmonicsUpToThePoles", "harmonic", Within(9e-7, 9.2e-8), false,
       DirectionsAreHarmonicsUpToThePoles},
  };
}

}  // namespace nerf
