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

constexpr float kMinNormalZ = 0.05f;      // steeper slopes are clamped to this one, 87 degrees
constexpr double kRegularisation = 1e-9;  // makes the mean of each part 0; otherwise negligible

struct Slope {
  double right, up, weight;
};

// Consecutive numbers for the pixels with a normal; -1 for the others.
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
  const double nz = std::max(kMinNormalZ, n[2]);
  return {-n[0] / nz, -n[1] / nz, nz};
}

// The normal equations of weighted differences; their matrix is a weighted Laplacian.
class Differences {
 public:
  explicit Differences(int count)
      : diagonal_(count, kRegularisation), b_(Eigen::VectorXd::Zero(count)) {}

  // Adds the equation z[to] - z[from] = rise with a weight.
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
  if (count > kMaxHeightPixels) {
    throw InputError(
        "{} pixels of normals: depth is computed for at most {}; mask the subject, or use smaller "
        "images",
        count, kMaxHeightPixels);
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
