#include "nerf/scene/lens_distortion.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace nerf {
namespace {

constexpr double kTolerance = 1e-11;
constexpr double kRounding = 4e-16;  // a residual that cannot decrease further
constexpr int kMaxNewtonSteps = 30;

// The derivative of the radius, d(r N/D)/dr, has the sign of this polynomial in s = r^2 where D >
// 0.
constexpr std::size_t kGrowthTerms = 8;
using GrowthPolynomial = std::array<double, kGrowthTerms>;

struct Radial {
  double factor;      // distorted radius / ideal radius
  double derivative;  // of the factor, by s
};

template <std::size_t N>
double Evaluate(const std::array<double, N>& coefficients, double s) {
  double value = 0;
  for (std::size_t i = N; i-- > 0;) value = value * s + coefficients[i];
  return value;
}

template <std::size_t N>
double EvaluateDerivative(const std::array<double, N>& coefficients, double s) {
  double value = 0;
  for (std::size_t i = N; i-- > 1;) value = value * s + static_cast<double>(i) * coefficients[i];
  return value;
}

// atan(x) / x at x = 2 r tan(omega / 2), times the scale at the centre.
Radial FovRadial(double omega, double s) {
  if (omega == 0) return {1, 0};
  const double a = 2 * std::tan(omega / 2);
  const double scale = a / omega;
  const double x2 = a * a * s;
  if (x2 < 1e-4) {  // a series, since the closed form is 0 / 0 at the centre
    return {scale * (1 - x2 * (1.0 / 3 - x2 * (1.0 / 5 - x2 / 7))),
            scale * a * a * (-1.0 / 3 + x2 * (2.0 / 5 - x2 * (3.0 / 7 - x2 * 4.0 / 9)))};
  }
  const double x = std::sqrt(x2);
  const double factor = std::atan(x) / x;
  return {scale * factor, scale * (1 / (1 + x2) - factor) / (2 * s)};
}

Radial RadialAt(const LensDistortion& lens, double s) {
  if (lens.fov_omega) return FovRadial(*lens.fov_omega, s);
  const double n = Evaluate(lens.numerator, s);
  const double d = Evaluate(lens.denominator, s);
  const double dn = EvaluateDerivative(lens.numerator, s);
  const double dd = EvaluateDerivative(lens.denominator, s);
  return {n / d, (dn * d - n * dd) / (d * d)};
}

Eigen::Vector2d Distort(const LensDistortion& lens, const Eigen::Vector2d& m) {
  const double s = m.squaredNorm();
  const double uv = m.x() * m.y();
  const auto [p1, p2] = std::pair(lens.tangential.x(), lens.tangential.y());
  return m * RadialAt(lens, s).factor + lens.prism * s +
         Eigen::Vector2d(2 * p1 * uv + p2 * (s + 2 * m.x() * m.x()),
                         2 * p2 * uv + p1 * (s + 2 * m.y() * m.y()));
}

Eigen::Matrix2d Jacobian(const LensDistortion& lens, const Eigen::Vector2d& m) {
  const Radial radial = RadialAt(lens, m.squaredNorm());
  const auto [u, v] = std::pair(m.x(), m.y());
  const auto [p1, p2] = std::pair(lens.tangential.x(), lens.tangential.y());
  Eigen::Matrix2d bend;
  bend << 2 * p1 * v + 6 * p2 * u, 2 * p1 * u + 2 * p2 * v,  //
      2 * p1 * u + 2 * p2 * v, 6 * p1 * v + 2 * p2 * u;
  return radial.factor * Eigen::Matrix2d::Identity() + 2 * radial.derivative * m * m.transpose() +
         bend + 2 * lens.prism * m.transpose();
}

// r N/D derived by r is (N D + 2 s (N' D - N D')) / D^2; this is its numerator.
GrowthPolynomial Growth(const LensDistortion& lens) {
  GrowthPolynomial growth{};
  for (std::size_t i = 0; i < lens.numerator.size(); ++i) {
    for (std::size_t j = 0; j < lens.denominator.size(); ++j) {
      const double weight = 1 + 2 * (static_cast<double>(i) - static_cast<double>(j));
      growth[i + j] += weight * lens.numerator[i] * lens.denominator[j];
    }
  }
  return growth;
}

// First root of a polynomial in [lo, hi] from its Bernstein coefficients there: none where all of
// them are positive, otherwise by halving the interval.
template <std::size_t N>
std::optional<double> FirstRootBernstein(const std::array<double, N>& b, double lo, double hi,
                                         int depth) {
  if (std::ranges::all_of(b, [](double x) { return x > 0; })) return std::nullopt;
  if (depth == 0 || !(b[0] > 0)) return lo;
  std::array<double, N> left{};
  std::array<double, N> right = b;
  for (std::size_t level = 0; level < N; ++level) {  // de Casteljau
    left[level] = right[0];
    for (std::size_t i = 0; i + level + 1 < N; ++i) right[i] = (right[i] + right[i + 1]) / 2;
  }
  const double middle = (lo + hi) / 2;
  if (const auto root = FirstRootBernstein(left, lo, middle, depth - 1)) return root;
  return FirstRootBernstein(right, middle, hi, depth - 1);
}

// First root in (0, limit] of a polynomial that is 1 at 0.
template <std::size_t N>
std::optional<double> FirstRoot(const std::array<double, N>& coefficients, double limit) {
  // For nearly every lens the polynomial is positive even without its positive terms.
  double lower_bound = 0;
  for (std::size_t i = N; i-- > 0;) {
    lower_bound = lower_bound * limit + (i == 0 ? coefficients[0] : std::min(coefficients[i], 0.0));
  }
  if (lower_bound > 0) return std::nullopt;

  std::array<double, N> scaled = coefficients;
  double power = 1;
  for (double& c : scaled) {
    c *= power;
    power *= limit;
  }
  std::array<double, N> bernstein{};
  for (std::size_t k = 0; k < N; ++k) {
    double ratio = 1;  // binomial(k, i) / binomial(N - 1, i)
    bernstein[k] = scaled[0];
    for (std::size_t i = 1; i <= k; ++i) {
      ratio *= static_cast<double>(k - i + 1) / static_cast<double>(N - i);
      bernstein[k] += ratio * scaled[i];
    }
  }
  constexpr int kMaxDepth = 80;  // halvings; enough to resolve 1e-16 of the widest limit
  return FirstRootBernstein(bernstein, 0.0, limit, kMaxDepth);
}

// Largest s = r^2 up to which the distorted radius increases, at most `limit`.
double ValidRadiusSquared(const LensDistortion& lens, double limit) {
  if (lens.fov_omega) return std::abs(*lens.fov_omega) < std::numbers::pi ? limit : 0.0;
  const double pole = FirstRoot(lens.denominator, limit).value_or(limit);
  return FirstRoot(Growth(lens), pole).value_or(pole);
}

bool IsInValidRange(const LensDistortion& lens, const Eigen::Vector2d& m) {
  if (!m.allFinite()) return false;
  const double s = m.squaredNorm();
  if (lens.is_fisheye && s > std::numbers::pi * std::numbers::pi) return false;
  if (ValidRadiusSquared(lens, s) < s) return false;
  const Eigen::Matrix2d jacobian = Jacobian(lens, m);
  // Tangential terms can fold the image too.
  return jacobian.determinant() > 0 && jacobian.trace() > 0;
}

std::optional<Eigen::Vector2d> Newton(const LensDistortion& lens, const Eigen::Vector2d& target,
                                      Eigen::Vector2d m) {
  const double size = std::max(1.0, target.norm());
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    const Eigen::Vector2d residual = Distort(lens, m) - target;
    if (!(residual.norm() > kRounding * size)) break;
    m -= Jacobian(lens, m).inverse() * residual;
  }
  const bool converged = (Distort(lens, m) - target).norm() <= kTolerance * size;
  return converged && IsInValidRange(lens, m) ? std::optional(m) : std::nullopt;
}

// Inverse of the radial part alone, by bisection in the valid range: slow, but it always converges.
Eigen::Vector2d RadialStart(const LensDistortion& lens, const Eigen::Vector2d& target) {
  constexpr double kFarthest = 1e4;  // tangent of 89.994 degrees
  double lo = 0;
  double hi = std::sqrt(
      ValidRadiusSquared(lens, std::pow(lens.is_fisheye ? std::numbers::pi : kFarthest, 2)));
  const double radius = target.norm();
  for (int step = 0; step < 60; ++step) {
    const double middle = (lo + hi) / 2;
    (middle * RadialAt(lens, middle * middle).factor < radius ? lo : hi) = middle;
  }
  return target * (lo / radius);
}

}  // namespace

std::optional<Eigen::Vector2d> DistortedFromIdeal(const LensDistortion& lens,
                                                  const Eigen::Vector2d& ideal) {
  if (!IsInValidRange(lens, ideal)) return std::nullopt;
  return Distort(lens, ideal);
}

std::optional<Eigen::Vector2d> IdealFromDistorted(const LensDistortion& lens,
                                                  const Eigen::Vector2d& distorted) {
  if (!distorted.allFinite()) return std::nullopt;
  if (distorted.isZero(0)) return distorted;
  if (const auto ideal = Newton(lens, distorted, distorted)) return ideal;
  return Newton(lens, distorted, RadialStart(lens, distorted));
}

}  // namespace nerf
