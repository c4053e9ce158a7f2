#include "nerf/material/dipole.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace nerf {
namespace {

using std::numbers::pi;

// 2 pi integral of R_d r dr, with r = tan(t) to cover all r.
Color Integrated(const Dipole& dipole) {
  Color sum = Color::Zero();
  constexpr int kSteps = 200000;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) / kSteps * pi / 2;
    const double r = std::tan(t);
    sum += dipole.DiffuseReflectance(r) * (r / std::pow(std::cos(t), 2));
  }
  return sum * (2 * pi * pi / 2 / kSteps);
}

TEST(Dipole, IntegratesToItsTotalDiffuseReflectance) {
  for (const Medium& medium : {MarbleMedium(), WholeMilkMedium(), SkinMedium()}) {
    const Dipole dipole(medium);
    EXPECT_LT((Integrated(dipole) - dipole.TotalDiffuseReflectance()).abs().maxCoeff(), 1e-4);
  }
}

// The column "diffuse reflectance" of Jensen et al. 2001, figure 5.
TEST(Dipole, MatchesThePublishedReflectances) {
  const auto expect = [](const Medium& medium, const Color& published) {
    const Color reflectance = Dipole(medium).TotalDiffuseReflectance();
    EXPECT_LT((reflectance - published).abs().maxCoeff(), 0.02)
        << reflectance.transpose() << " instead of " << published.transpose();
  };
  expect(MarbleMedium(), {0.83, 0.79, 0.75});
  expect(WholeMilkMedium(), {0.91, 0.88, 0.76});
  expect(SkinMedium(), {0.44, 0.22, 0.13});
}

// An independent implementation of the formula in the paper, for one channel in long double.
TEST(Dipole, MatchesThePublishedProfile) {
  const long double s = 2.19L;
  const long double a = 0.0021L;
  const long double eta = 1.5L;
  const long double st = s + a;
  const long double str = std::sqrt(3 * a * st);
  const long double Fdr = -1.440L / (eta * eta) + 0.710L / eta + 0.668L + 0.0636L * eta;
  const long double zr = 1 / st;
  const long double zv = zr + 4 * (1 + Fdr) / (1 - Fdr) / (3 * st);
  const Dipole dipole(MarbleMedium());
  for (const double r : {0.0, 0.1, 1.0, 5.0, 20.0}) {
    const long double dr = std::sqrt(r * r + zr * zr);
    const long double dv = std::sqrt(r * r + zv * zv);
    const long double expected = s / st / (4 * pi) *
                                 (zr * (str * dr + 1) * std::exp(-str * dr) / (dr * dr * dr) +
                                  zv * (str * dv + 1) * std::exp(-str * dv) / (dv * dv * dv));
    EXPECT_NEAR(dipole.DiffuseReflectance(r).x() / static_cast<double>(expected), 1, 1e-9) << r;
  }
}

TEST(Dipole, IsIndependentOfTheUnitOfLength) {
  const Dipole in_millimeters(MarbleMedium());
  const Dipole in_meters(InUnits(MarbleMedium(), 1e-3));
  EXPECT_TRUE(in_meters.TotalDiffuseReflectance().isApprox(in_millimeters.TotalDiffuseReflectance(),
                                                           1e-12));
  EXPECT_TRUE((in_meters.DiffuseReflectance(2e-3) * 1e-6)
                  .isApprox(in_millimeters.DiffuseReflectance(2), 1e-9));
}

TEST(Dipole, ReturnsAllLightWithoutAbsorption) {
  Medium clear = MarbleMedium();
  clear.absorption.setZero();
  EXPECT_NEAR(Dipole(clear).TotalDiffuseReflectance().x(), 1, 1e-12);
}

}  // namespace
}  // namespace nerf
