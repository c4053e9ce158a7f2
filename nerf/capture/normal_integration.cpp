#include "nerf/capture/normal_integration.h"

#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "nerf/base/input_error.h"

namespace nerf {
namespace {

constexpr float kSteepest = 0.05f;  // n_z below which a slope is cut off: 87 degrees
constexpr double kAnchor = 1e-9;    // pulls each part's mean to 0; no equation feels it

struct Slope {
  double right, up, weight;
};

// Numbers the pixels inside; -1 outside.
std::vector<int> NumberPixels(const Image& normal, int& count) {
  std::vector<int> number(normal.pixels.size() / 3, -1);
  count = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    const float* n = &normal.pixels[i * 3];
    if (n[0] != 0 || n[1] != 0 || n[2] != 0) number[i] = count++;
  }
  return number;
}

Slope SlopeAt(const float* n) {
  const double nz = std::max(kSteepest, n[2]);
  return {-n[0] / nz, -n[1] / nz, nz};
}

// The normal equations of the differences, which are those of a weighted Laplacian.
class Differences {
 public:
  explicit Differences(int count) : diagonal_(count, kAnchor), b_(Eigen::VectorXd::Zero(count)) {}

  // z[to] - z[from] = rise, with this weight.
  void Add(int from, int to, double rise, double weight) {
    diagonal_[static_cast<std::size_t>(from)] += weight;
    diagonal_[static_cast<std::size_t>(to)] += weight;
    entries_.emplace_back(std::max(from, to), std::min(from, to), -weight);
    b_[to] += weight * rise;
    b_[from] -= weight * rise;
  }

  Eigen::VectorXd Solve() {
    const auto count = static_cast<int>(diagonal_.size());
    for (int i = 0; i < count; ++i) {
      entries_.emplace_back(i, i, diagonal_[static_cast<std::size_t>(i)]);
    }
    Eigen::SparseMatrix<double> laplacian(count, count);
    laplacian.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> factors(laplacian);
    return factors.solve(b_);
  }

 private:
  std::vector<double> diagonal_;
  std::vector<Eigen::Triplet<double>> entries_;  // lower triangle
  Eigen::VectorXd b_;
};

}  // namespace

Image IntegrateNormals(const Image& normal) {
  int count = 0;
  const std::vector<int> number = NumberPixels(normal, count);
  if (count > kMostPixels) {
    throw InputError(
        "{} pixels of normals: depth is for {} at most; mask the subject, or take "
        "smaller images",
        count, kMostPixels);
  }
  Differences differences(count);
  const auto join = [&](int x, int y, int dx, int dy) {
    if (x + dx >= normal.width || y + dy < 0) return;
    const auto at = static_cast<std::size_t>(y) * normal.width + x;
    const auto next = static_cast<std::size_t>(y + dy) * normal.width + x + dx;
    if (number[at] < 0 || number[next] < 0) return;
    const Slope a = SlopeAt(normal.At(x, y));
    const Slope b = SlopeAt(normal.At(x + dx, y + dy));
    const double rise = dx != 0 ? (a.right + b.right) / 2 : (a.up + b.up) / 2;
    differences.Add(number[at], number[next], rise, std::min(a.weight, b.weight));
  };
  for (int y = 0; y < normal.height; ++y) {
    for (int x = 0; x < normal.width; ++x) {
      join(x, y, 1, 0);
      join(x, y, 0, -1);
    }
  }
  Image height(normal.width, normal.height, 1, ColorEncoding::kLinear);
  std::ranges::fill(height.pixels, std::numeric_limits<float>::quiet_NaN());
  if (count == 0) return height;
  const Eigen::VectorXd z = differences.Solve();
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] >= 0) height.pixels[i] = static_cast<float>(z[number[i]]);
  }
  return height;
}

}  // namespace nerf
