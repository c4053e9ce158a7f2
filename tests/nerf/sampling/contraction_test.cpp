#include "nerf/sampling/contraction.h"

#include <gtest/gtest.h>

namespace nerf {
namespace {

TEST(Contraction, IsTheIdentityInsideTheUnitBall) {
  for (const Eigen::Vector3f& x :
       {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(0.5f, -0.2f, 0.1f), Eigen::Vector3f(0, 1, 0)}) {
    EXPECT_EQ(Contract(x), x);
  }
}

TEST(Contraction, IsBoundedByTwoAtAnyDistance) {
  for (const float r : {1.5f, 10.0f, 1e6f, 1e19f, 1e30f}) {
    const float norm = Contract(Eigen::Vector3f(0.6f, 0.8f, 0.0f) * r).norm();
    EXPECT_LE(norm, 2.0f + 1e-6f);
    EXPECT_NEAR(norm, 2.0f - 1.0f / r, 1e-6f);
  }
}

TEST(Contraction, UncontractInvertsContract) {
  for (const float r : {0.1f, 0.99f, 1.0f, 1.01f, 3.0f, 50.0f}) {
    const Eigen::Vector3f x = Eigen::Vector3f(2, -1, 0.5f).normalized() * r;
    EXPECT_LT((Uncontract(Contract(x)) - x).norm(), 1e-3f * r);
  }
}

TEST(Contraction, SpeedIsTheDerivativeAlongTheDirection) {
  for (const float r : {0.5f, 1.2f, 2.0f, 8.0f}) {
    const Eigen::Vector3f x = Eigen::Vector3f(1, 2, -0.5f).normalized() * r;
    for (const Eigen::Vector3f& along :
         {Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(0.3f, -0.9f, 0.2f), x}) {
      const Eigen::Vector3f d = along.normalized();
      const float h = 1e-2f * r;
      const float numeric = (Contract(x + h * d) - Contract(x - h * d)).norm() / (2 * h);
      EXPECT_NEAR(ContractedSpeed(x, d), numeric, 2e-3f * numeric) << "r = " << r;
    }
  }
}

TEST(Contraction, TheUnitCubeContainsAllOfContractedSpace) {
  EXPECT_EQ(UnitCubeFromContracted({-2, 0, 2}), Eigen::Vector3f(0, 0.5f, 1));
  EXPECT_EQ(ContractedFromUnitCube({0, 0.5f, 1}), Eigen::Vector3f(-2, 0, 2));
}

}  // namespace
}  // namespace nerf
