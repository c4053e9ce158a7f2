#include "sfm/epipolar_geometry.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace nerf::sfm {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Pairs of two cameras: `good` of points that both see, then `bad` ones at random.
struct TwoViews {
  std::vector<PointPair> pairs;
  Matrix3d fundamental;  // true, norm 1

  TwoViews(int good, int bad, double noise, std::uint32_t seed = 1, bool plane = false) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::normal_distribution<double> gauss;
    Matrix3d k;
    k << 700, 0, 400, 0, 700, 300, 0, 0, 1;
    const Matrix3d rotation =
        Eigen::AngleAxisd(0.2, Vector3d(0.2, 1, 0.1).normalized()).toRotationMatrix();
    const Vector3d t(-1, 0.1, 0.2);
    Matrix3d cross;
    cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
    fundamental = k.inverse().transpose() * cross * rotation * k.inverse();
    fundamental /= fundamental.norm();
    const auto noisy = [&](const Vector3d& p) -> Vector2d {
      return (k * p).hnormalized() + noise * Vector2d(gauss(generator), gauss(generator));
    };
    for (int i = 0; i < good; ++i) {
      const double z = plane ? 5 : 5 + 2 * uniform(generator);
      const Vector3d x(2 * uniform(generator), 2 * uniform(generator), z);
      pairs.push_back({noisy(x), noisy(rotation * x + t)});
    }
    const auto anywhere = [&] {
      return Vector2d(400 + 400 * uniform(generator), 300 + 300 * uniform(generator));
    };
    for (int i = 0; i < bad; ++i) pairs.push_back({anywhere(), anywhere()});
  }
};

double Difference(const Matrix3d& a, const Matrix3d& b) {
  return std::min((a / a.norm() - b).norm(), (a / a.norm() + b).norm());
}

TEST(FundamentalMatrix, OfExactPairsIsExact) {
  const TwoViews views(30, 0, 0);
  const auto many = FundamentalOfMany(views.pairs);
  ASSERT_TRUE(many);
  EXPECT_LT(Difference(*many, views.fundamental), 1e-8);
  double nearest = 1;
  for (const Matrix3d& f : FundamentalOfSeven(views.pairs)) {
    nearest = std::min(nearest, Difference(f, views.fundamental));
    for (int i = 0; i < 7; ++i) EXPECT_LT(SquaredSampsonError(f, views.pairs[i]), 1e-12);
    EXPECT_NEAR(f.determinant(), 0, 1e-12);
  }
  EXPECT_LT(nearest, 1e-6);
}

TEST(FundamentalMatrix, OfTooFewOrEqualPairsIsNone) {
  const TwoViews views(7, 0, 0);
  EXPECT_FALSE(FundamentalOfMany(views.pairs));
  const std::vector<PointPair> equal(9, views.pairs[0]);
  EXPECT_TRUE(FundamentalOfSeven(equal).empty());
}

// The distance to the nearest pair that fits exactly.
TEST(SampsonError, IsTheDistanceForSmallErrors) {
  const TwoViews views(20, 0, 0);
  for (PointPair pair : views.pairs) {
    const Vector3d line = views.fundamental * pair.first.homogeneous();
    const Vector3d back = views.fundamental.transpose() * pair.second.homogeneous();
    Eigen::Vector4d normal;
    normal << back.head<2>(), line.head<2>();
    normal *= 0.5 / normal.norm();
    pair.first += normal.head<2>();
    pair.second += normal.tail<2>();
    EXPECT_NEAR(std::sqrt(SquaredSampsonError(views.fundamental, pair)), 0.5, 0.01);
  }
}

class EpipolarFit : public testing::TestWithParam<double> {};

// With as many wrong pairs as the options allow.
TEST_P(EpipolarFit, FindsThePairsThatAgree) {
  const int good = 200, bad = static_cast<int>(good / GetParam()) - good;
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const TwoViews views(good, bad, 0.5, seed);
    const auto found = FitEpipolarGeometry(views.pairs, {}, seed);
    ASSERT_TRUE(found) << seed;
    int right = 0, wrong = 0;
    for (const int i : found->inliers) ++(i < good ? right : wrong);
    EXPECT_GE(right, 0.97 * good);
    EXPECT_LE(wrong, 0.08 * bad);  // as many lie near their line by chance
    EXPECT_EQ(FitEpipolarGeometry(views.pairs, {}, seed)->inliers, found->inliers);
  }
}
INSTANTIATE_TEST_SUITE_P(ShareOfInliers, EpipolarFit, testing::Values(1.0, 0.8, 0.5, 0.4));

TEST(EpipolarGeometry, OfAPlaneKeepsItsPairs) {
  const TwoViews views(150, 50, 0.5, 1, true);
  const auto found = FitEpipolarGeometry(views.pairs, {}, 1);
  ASSERT_TRUE(found);
  EXPECT_GE(std::ranges::count_if(found->inliers, [](int i) { return i < 150; }), 145);
}

TEST(EpipolarGeometry, OfRandomPairsIsNone) {
  EXPECT_FALSE(FitEpipolarGeometry(TwoViews(0, 100, 0).pairs, {}, 1));
  EXPECT_FALSE(FitEpipolarGeometry(TwoViews(14, 0, 0).pairs, {}, 1));
  EXPECT_TRUE(FitEpipolarGeometry(TwoViews(15, 0, 0).pairs, {}, 1));
  EXPECT_FALSE(FitEpipolarGeometry({}, {}, 1));
}

}  // namespace
}  // namespace nerf::sfm
