#include "nerf/transport/subsurface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nerf/geometry/directions.h"

namespace nerf {
namespace {

using Eigen::Vector3d;

TEST(SubsurfaceSphere, HasTheTotalReflectanceUnderUniformLight) {
  // A sphere much larger than the diffusion length is nearly flat; its curvature explains the rest.
  const SubsurfaceSphere ball({{0, 0, 0}, 15}, Medium{{2, 2, 2}, {0.2, 0.5, 1.0}, 1.3});
  const Color expected = ball.dipole().TotalDiffuseReflectance();
  EXPECT_LT(((ball.UniformReflectance() - expected) / expected).abs().maxCoeff(), 0.08)
      << ball.UniformReflectance().transpose() << " instead of " << expected.transpose();
}

// Mean over the sphere of a function of the unit normal.
template <class Function>
Color MeanOverSphere(Function function) {
  constexpr int kNormals = 20000;
  Color sum = Color::Zero();
  for (int i = 0; i < kNormals; ++i) sum += function(FibonacciDirection(i, kNormals));
  return sum / kNormals;
}

// Lit from one side, the sphere emits the same share of the incoming energy as under uniform light,
// because R_d is symmetric. The points of the sphere are not quite evenly spaced, hence 3 %.
TEST(SubsurfaceSphere, EmitsItsReflectanceTimesTheIncomingEnergy) {
  constexpr double kRadius = 6;  // mm
  for (const Medium& medium : {MarbleMedium(), WholeMilkMedium(), SkinMedium()}) {
    const auto ball = std::make_shared<SubsurfaceSphere>(Sphere{{1, 2, 3}, kRadius}, medium);
    const auto irradiance = [](const Vector3d& normal) -> Color {
      return Color(3, 2, 1) * std::max(0.0, normal.dot(Vector3d(0.6, 0, 0.8)));
    };
    const auto exitance = SubsurfaceSphere::Illuminate(
        ball, [&](int, const Vector3d&, const Vector3d& normal) { return irradiance(normal); });
    const Color entering = MeanOverSphere(irradiance);
    const Color leaving = MeanOverSphere(
        [&](const Vector3d& n) { return exitance.At(Vector3d(1, 2, 3) + kRadius * n); });
    const Color reflectance = ball->UniformReflectance();
    EXPECT_LT((leaving / entering / reflectance - 1).abs().maxCoeff(), 0.03);
    EXPECT_LT((leaving / entering).maxCoeff(), 1);
  }
}

}  // namespace
}  // namespace nerf
