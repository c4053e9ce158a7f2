#include "sfm/epipolar_geometry.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace nerf::sfm {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kSample = 7;
constexpr int kRefinements = 3;  // of a model that is better than all before

// The row of x2^T F x1 = 0 for F by rows.
Eigen::Matrix<double, 1, 9> RowOf(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  Eigen::Matrix<double, 1, 9> row;
  row << b.x() * a.x(), b.x() * a.y(), b.x(), b.y() * a.x(), b.y() * a.y(), b.y(), a.x(), a.y(), 1;
  return row;
}

Matrix3d FromRow(const Eigen::Matrix<double, 9, 1>& f) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(f.data());
}

// Moves points about the origin, at a mean distance of sqrt(2).
template <class Get>
Matrix3d Normalization(std::span<const PointPair> pairs, Get get) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const PointPair& pair : pairs) mean += get(pair);
  mean /= static_cast<double>(pairs.size());
  double distance = 0;
  for (const PointPair& pair : pairs) distance += (get(pair) - mean).norm();
  distance /= static_cast<double>(pairs.size());
  const double scale = distance > 0 ? std::numbers::sqrt2 / distance : 1;
  Matrix3d matrix;
  matrix << scale, 0, -scale * mean.x(), 0, scale, -scale * mean.y(), 0, 0, 1;
  return matrix;
}

struct Normalized {
  std::vector<PointPair> pairs;
  Matrix3d first, second;

  explicit Normalized(std::span<const PointPair> of)
      : pairs(of.begin(), of.end()),
        first(Normalization(of, [](const PointPair& p) { return p.first; })),
        second(Normalization(of, [](const PointPair& p) { return p.second; })) {
    for (PointPair& pair : pairs) {
      pair.first = first(0, 0) * pair.first + first.topRightCorner<2, 1>();
      pair.second = second(0, 0) * pair.second + second.topRightCorner<2, 1>();
    }
  }
  Matrix3d InPixels(const Matrix3d& fundamental) const {
    const Matrix3d matrix = second.transpose() * fundamental * first;
    return matrix / matrix.norm();
  }
};

// The real roots of a cubic polynomial, c[3] x^3 + ... + c[0].
std::vector<double> RootsOfCubic(const std::array<double, 4>& c) {
  const double largest = std::max({std::fabs(c[0]), std::fabs(c[1]), std::fabs(c[2])});
  if (std::fabs(c[3]) <= 1e-12 * largest) return {};
  const double a = c[2] / c[3], b = c[1] / c[3], d = c[0] / c[3];
  const double q = (a * a - 3 * b) / 9, r = (2 * a * a * a - 9 * a * b + 27 * d) / 54;
  if (r * r < q * q * q) {
    const double angle = std::acos(std::clamp(r / std::sqrt(q * q * q), -1.0, 1.0));
    std::vector<double> roots;
    for (const int k : {-1, 0, 1}) {
      roots.push_back(-2 * std::sqrt(q) * std::cos((angle + 2 * std::numbers::pi * k) / 3) - a / 3);
    }
    return roots;
  }
  const double s = -std::copysign(std::cbrt(std::fabs(r) + std::sqrt(r * r - q * q * q)), r);
  return {s + (s == 0 ? 0 : q / s) - a / 3};
}

// Finds the pairs within an error of a model. Of structure of arrays, in single precision, so that
// the compiler makes vectors of it.
class InlierCounter {
 public:
  InlierCounter(std::span<const PointPair> pairs, double max_error)
      : limit_(static_cast<float>(max_error * max_error)) {
    for (const PointPair& pair : pairs) {
      x1_.push_back(static_cast<float>(pair.first.x()));
      y1_.push_back(static_cast<float>(pair.first.y()));
      x2_.push_back(static_cast<float>(pair.second.x()));
      y2_.push_back(static_cast<float>(pair.second.y()));
    }
  }

  int Count(const Matrix3d& fundamental) const {
    const Eigen::Matrix3f f = fundamental.cast<float>();
    const float f00 = f(0, 0), f01 = f(0, 1), f02 = f(0, 2), f10 = f(1, 0), f11 = f(1, 1),
                f12 = f(1, 2), f20 = f(2, 0), f21 = f(2, 1), f22 = f(2, 2), limit = limit_;
    const float *const x1 = x1_.data(), *const y1 = y1_.data(), *const x2 = x2_.data(),
                       *const y2 = y2_.data();
    const int count = static_cast<int>(x1_.size());
    int inliers = 0;
    for (int i = 0; i < count; ++i) {
      const float a = f00 * x1[i] + f01 * y1[i] + f02, b = f10 * x1[i] + f11 * y1[i] + f12;
      const float c = f00 * x2[i] + f10 * y2[i] + f20, d = f01 * x2[i] + f11 * y2[i] + f21;
      const float e = x2[i] * a + y2[i] * b + f20 * x1[i] + f21 * y1[i] + f22;
      inliers += e * e <= limit * (a * a + b * b + c * c + d * d) ? 1 : 0;
    }
    return inliers;
  }

 private:
  float limit_;
  std::vector<float> x1_, y1_, x2_, y2_;
};

std::vector<int> InliersOf(const Matrix3d& fundamental, std::span<const PointPair> pairs,
                           double max_error) {
  std::vector<int> inliers;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (SquaredSampsonError(fundamental, pairs[i]) <= max_error * max_error) {
      inliers.push_back(static_cast<int>(i));
    }
  }
  return inliers;
}

// Improves a model by least squares of its inliers as long as it gains some.
void Refine(std::span<const PointPair> pairs, const InlierCounter& counter, double max_error,
            Matrix3d& fundamental, int& count) {
  for (int i = 0; i < kRefinements; ++i) {
    std::vector<PointPair> inliers;
    for (const int at : InliersOf(fundamental, pairs, max_error)) inliers.push_back(pairs[at]);
    const auto refined = FundamentalOfMany(inliers);
    if (!refined) return;
    const int refined_count = counter.Count(*refined);
    if (refined_count <= count) return;
    fundamental = *refined;
    count = refined_count;
  }
}

// Trials until a sample without outliers is found with this confidence.
int TrialsFor(double inlier_ratio, double confidence, int most) {
  const double good = std::pow(inlier_ratio, kSample);
  if (good >= 1) return 1;
  if (good < 1e-9) return most;
  return static_cast<int>(
      std::min<double>(most, std::ceil(std::log(1 - confidence) / std::log1p(-good))));
}

}  // namespace

double SquaredSampsonError(const Matrix3d& fundamental, const PointPair& pair) {
  const Vector3d first = pair.first.homogeneous(), second = pair.second.homogeneous();
  const Vector3d line = fundamental * first, back = fundamental.transpose() * second;
  const double error = second.dot(line);
  const double squared = line.head<2>().squaredNorm() + back.head<2>().squaredNorm();
  return squared > 0 ? error * error / squared : std::numeric_limits<double>::infinity();
}

std::vector<Matrix3d> FundamentalOfSeven(std::span<const PointPair> pairs) {
  const Normalized normalized(pairs.first(kSample));
  Eigen::Matrix<double, kSample, 9> rows;
  for (int i = 0; i < kSample; ++i) {
    rows.row(i) = RowOf(normalized.pairs[i].first, normalized.pairs[i].second);
  }
  const Eigen::FullPivLU<Eigen::Matrix<double, kSample, 9>> lu(rows);
  if (lu.rank() < kSample) return {};
  const Eigen::Matrix<double, 9, Eigen::Dynamic> kernel = lu.kernel();
  const Matrix3d a = FromRow(kernel.col(0)), b = FromRow(kernel.col(1));
  // det(x a + (1 - x) b) = 0 is a cubic in x, known from four of its values.
  const auto determinant = [&](double x) { return (x * a + (1 - x) * b).determinant(); };
  const double at_0 = determinant(0), at_1 = determinant(1), at_minus = determinant(-1),
               at_2 = determinant(2);
  const double c2 = (at_1 + at_minus) / 2 - at_0, odd = (at_1 - at_minus) / 2;
  const double c3 = (at_2 - at_0 - 4 * c2 - 2 * odd) / 6;
  std::vector<Matrix3d> found;
  for (const double x : RootsOfCubic({at_0, odd - c3, c2, c3})) {
    found.push_back(normalized.InPixels(x * a + (1 - x) * b));
  }
  return found;
}

std::optional<Matrix3d> FundamentalOfMany(std::span<const PointPair> pairs) {
  if (pairs.size() < 8) return std::nullopt;
  const Normalized normalized(pairs);
  Eigen::Matrix<double, 9, 9> squares = Eigen::Matrix<double, 9, 9>::Zero();
  for (const PointPair& pair : normalized.pairs) {
    const Eigen::Matrix<double, 1, 9> row = RowOf(pair.first, pair.second);
    squares += row.transpose() * row;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(squares);
  if (solver.info() != Eigen::Success) return std::nullopt;
  const Eigen::JacobiSVD<Matrix3d> svd(FromRow(solver.eigenvectors().col(0)),
                                       Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d values = svd.singularValues();
  if (!(values(1) > 0)) return std::nullopt;
  values(2) = 0;  // epipolar lines meet in one point
  return normalized.InPixels(svd.matrixU() * values.asDiagonal() * svd.matrixV().transpose());
}

std::optional<EpipolarGeometry> FitEpipolarGeometry(std::span<const PointPair> pairs,
                                                    const EpipolarOptions& options,
                                                    std::uint32_t seed) {
  const int count = static_cast<int>(pairs.size());
  const int fewest = std::max({options.min_inliers, kSample + 1,
                               static_cast<int>(std::ceil(options.min_inlier_ratio * count))});
  if (count < fewest) return std::nullopt;
  const InlierCounter counter(pairs, options.max_error);
  std::mt19937 generator(seed);
  std::uniform_int_distribution<int> any(0, count - 1);
  Matrix3d best = Matrix3d::Zero();
  int best_count = 0;
  int trials = TrialsFor(options.min_inlier_ratio, options.confidence, options.max_trials);
  for (int trial = 0; trial < trials; ++trial) {
    std::array<int, kSample> sample{};
    for (int i = 0; i < kSample; ++i) {
      do {
        sample[i] = any(generator);
      } while (std::find(sample.begin(), sample.begin() + i, sample[i]) != sample.begin() + i);
    }
    std::array<PointPair, kSample> chosen;
    std::ranges::transform(sample, chosen.begin(), [&](int i) { return pairs[i]; });
    for (Matrix3d model : FundamentalOfSeven(chosen)) {
      int inliers = counter.Count(model);
      if (inliers <= best_count) continue;
      Refine(pairs, counter, options.max_error, model, inliers);
      best = model;
      best_count = inliers;
      trials = TrialsFor(static_cast<double>(best_count) / count, options.confidence,
                         options.max_trials);
    }
  }
  EpipolarGeometry geometry{best, InliersOf(best, pairs, options.max_error)};
  if (static_cast<int>(geometry.inliers.size()) < fewest) return std::nullopt;
  return geometry;
}

}  // namespace nerf::sfm
