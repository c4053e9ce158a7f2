#include <gtest/gtest.h>

#include <memory>
#include <numbers>
#include <string>

#include "nerf/geometry/directions.h"
#include "nerf/material/coated_diffuse.h"
#include "nerf/material/lambert.h"
#include "nerf/material/merl.h"
#include "nerf/material/metallic_roughness.h"
#include "tests/support/chi_square.h"

namespace nerf {
namespace {

using Eigen::Vector3d;

using std::numbers::pi;
constexpr double kCosines[] = {1.0, 0.8, 0.4, 0.1, 0.01};

Vector3d Towards(double cosine) { return {std::sqrt(1 - cosine * cosine), 0, cosine}; }

// All BRDFs by name; the MERL BRDF is a tabulated rough metal.
struct Named {
  std::string name;
  std::shared_ptr<const Brdf> brdf;
};

void PrintTo(const Named& named, std::ostream* out) { *out << named.name; }

std::vector<Named> AllBrdfs() {
  const Color gold(1.0, 0.78, 0.34);
  const Color red(0.8, 0.2, 0.1);
  return {{"Lambert", std::make_shared<Lambert>(red)},
          {"Metal_0_2", std::make_shared<Conductor>(gold, 0.2)},
          {"Metal_0_5", std::make_shared<Conductor>(gold, 0.5)},
          {"Metal_1", std::make_shared<Conductor>(gold, 1.0)},
          {"Plastic_0_2", std::make_shared<CoatedDiffuse>(red, 1.5, 0.2)},
          {"Plastic_0_7", std::make_shared<CoatedDiffuse>(red, 1.5, 0.7)},
          {"Dielectric", std::make_shared<MetallicRoughness>(red, 0.5, 0.0)},
          {"HalfMetal", std::make_shared<MetallicRoughness>(gold, 0.6, 0.5)},
          {"White", std::make_shared<MetallicRoughness>(Color::Ones(), 1.0, 0.0)},
          {"Merl", std::make_shared<MerlBrdf>(MerlBrdf::Tabulate(Conductor(gold, 0.3)))}};
}

// The integral of f cos over the hemisphere on a fine grid, independent of Sample and Pdf.
Color DirectionalAlbedo(const Brdf& brdf, const Vector3d& w_o, int steps = 256) {
  Color sum = Color::Zero();
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < 2 * steps; ++j) {
      const Eigen::Array2d u((i + 0.5) / steps, (j + 0.5) / (2 * steps));
      sum += brdf.Eval(w_o, CosineOnHemisphere(u));
    }
  }
  return sum * pi / (2.0 * steps * steps);
}

class EveryBrdf : public testing::TestWithParam<Named> {};

TEST_P(EveryBrdf, IsReciprocal) {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Vector3d a = CosineOnHemisphere(test::Uniform3(1, i).head<2>());
    const Vector3d b = CosineOnHemisphere(test::Uniform3(2, i).head<2>());
    const Color forth = GetParam().brdf->Eval(a, b);
    const Color back = GetParam().brdf->Eval(b, a);
    ASSERT_LT((forth - back).abs().maxCoeff(), 1e-9 * (1 + forth.maxCoeff()));
  }
}

TEST_P(EveryBrdf, ConservesEnergy) {
  for (const double cosine : kCosines) {
    const Color albedo = DirectionalAlbedo(*GetParam().brdf, Towards(cosine));
    EXPECT_LE(albedo.maxCoeff(), 1.005) << cosine;
    EXPECT_GE(albedo.minCoeff(), 0);
  }
}

TEST_P(EveryBrdf, SamplesFollowThePdf) {
  const Brdf& brdf = *GetParam().brdf;
  for (const double cosine : {0.9, 0.3}) {
    const Vector3d w_o = Towards(cosine);
    const double deviation = test::ChiSquareDeviation(
        [&](std::uint64_t i) {
          const auto sample = brdf.Sample(w_o, test::Uniform3(7, i));
          return sample ? sample->w_i : Vector3d(Vector3d::Zero());
        },
        [&](const Vector3d& w_i) { return brdf.Pdf(w_o, w_i); });
    EXPECT_LT(deviation, 5) << cosine;
  }
}

TEST_P(EveryBrdf, SamplesEstimateTheDirectionalAlbedo) {
  const Brdf& brdf = *GetParam().brdf;
  for (const double cosine : {1.0, 0.5, 0.1}) {
    const Vector3d w_o = Towards(cosine);
    constexpr int kDraws = 40000;
    Color sum = Color::Zero();
    for (std::uint64_t i = 0; i < kDraws; ++i) {
      const auto sample = brdf.Sample(w_o, test::Uniform3(3, i));
      if (!sample) continue;
      ASSERT_NEAR(sample->pdf, brdf.Pdf(w_o, sample->w_i), 1e-9 * sample->pdf);
      ASSERT_TRUE(sample->f.isApprox(brdf.Eval(w_o, sample->w_i), 1e-9));
      sum += sample->f * (sample->w_i.z() / sample->pdf);
    }
    const Color expected = DirectionalAlbedo(brdf, w_o);
    EXPECT_LT((sum / kDraws - expected).abs().maxCoeff(), 0.02) << cosine;
  }
}

TEST_P(EveryBrdf, ReflectsNothingBelowTheSurface) {
  const Vector3d above(0.3, 0.1, 0.9);
  const Vector3d below(0.3, 0.1, -0.9);
  const Brdf& brdf = *GetParam().brdf;
  EXPECT_TRUE(brdf.Eval(above, below).isZero());
  EXPECT_TRUE(brdf.Eval(below, above).isZero());
  EXPECT_EQ(brdf.Pdf(above, below), 0);
  EXPECT_FALSE(brdf.Sample(below, {0.5, 0.5, 0.5}));
}

INSTANTIATE_TEST_SUITE_P(Brdf, EveryBrdf, testing::ValuesIn(AllBrdfs()),
                         [](const auto& tested) { return tested.param.name; });

TEST(Ggx, NormalsAreNormalised) {
  for (const double alpha : {0.1, 0.3, 1.0}) {
    const Ggx facets(alpha);
    double sum = 0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const double theta = (i + 0.5) / kSteps * pi / 2;
      sum += facets.NormalDensity(Towards(std::cos(theta))) * std::cos(theta) * std::sin(theta);
    }
    EXPECT_NEAR(sum * 2 * pi * (pi / 2) / kSteps, 1, 1e-6) << alpha;
  }
}

// The projected area of the facets visible from w is that of the surface (Heitz 2014, eq. 16).
TEST(Ggx, VisibleFacetsHaveTheProjectedAreaOfTheSurface) {
  for (const double alpha : {0.1, 0.5, 1.0}) {
    const Ggx facets(alpha);
    for (const double cosine : {1.0, 0.5, 0.1}) {
      const Vector3d w = Towards(cosine);
      double sum = 0;
      constexpr int kDraws = 400000;
      for (int i = 0; i < kDraws; ++i) {  // uniform over the hemisphere, by a lattice
        const Vector3d h = FibonacciDirection(i, 2 * kDraws);
        sum += std::max(0.0, w.dot(h)) * facets.NormalDensity(h) * facets.Masking(cosine);
      }
      EXPECT_NEAR(sum * 2 * pi / kDraws, cosine, 2e-3 * cosine + 1e-4) << alpha << " " << cosine;
    }
  }
}

// Without shadowing of the reflected light, and with F = 1, all light is reflected.
TEST(Ggx, PassesTheWeakWhiteFurnace) {
  for (const double alpha : {0.15, 0.5, 1.0}) {
    const Ggx facets(alpha);
    for (const double cosine : {1.0, 0.6, 0.2}) {
      const Vector3d w_o = Towards(cosine);
      double sum = 0;
      constexpr int kDraws = 400000;
      for (int i = 0; i < kDraws; ++i) {
        const Vector3d w_i = FibonacciDirection(i, kDraws);
        const Vector3d h = (w_o + w_i).normalized();
        if (h.z() <= 0) continue;
        sum += facets.Masking(cosine) * facets.NormalDensity(h) / (4 * cosine);
      }
      EXPECT_NEAR(sum * 4 * pi / kDraws, 1, 5e-3) << alpha << " " << cosine;
    }
  }
}

TEST(Conductor, ConvergesToAMirrorAtLowRoughness) {
  const Color F0(0.9, 0.6, 0.3);
  for (const double alpha : {1e-2, 1e-3, 0.0}) {
    const Conductor metal(F0, alpha);
    for (const double cosine : {1.0, 0.5, 1e-2}) {
      const Vector3d w_o = Towards(cosine);
      const Vector3d mirrored(-w_o.x(), 0, w_o.z());
      Color sum = Color::Zero();
      for (std::uint64_t i = 0; i < 2000; ++i) {
        const auto sample = metal.Sample(w_o, test::Uniform3(4, i));
        if (!sample) continue;
        ASSERT_TRUE(sample->f.isFinite().all());
        ASSERT_GT(sample->pdf, 0);
        if (cosine > 0.1) {
          ASSERT_LT((sample->w_i - mirrored).norm(), 150 * std::max(alpha, 1e-3));
        }
        sum += sample->f * (sample->w_i.z() / sample->pdf);
      }
      const Color expected = SchlickFresnel(F0, cosine);
      EXPECT_LT((sum / 2000 - expected).abs().maxCoeff(), cosine > 0.1 ? 0.02 : 0.4);
    }
  }
}

TEST(Conductor, IsFiniteAtGrazingAngles) {
  for (const double alpha : {0.0, 1e-3, 0.1, 1.0}) {
    const Conductor metal(Color::Ones(), alpha);
    for (const double v : {1e-4, 1e-8, 1e-16, 1e-300}) {
      for (const double l : {1.0, 1e-4, 1e-16, 1e-300}) {
        const Vector3d w_o = Towards(v);
        const Vector3d w_i(-std::sqrt(1 - l * l), 0, l);
        EXPECT_TRUE((metal.Eval(w_o, w_i) * l).isFinite().all()) << alpha << " " << v << " " << l;
        EXPECT_TRUE(std::isfinite(metal.Pdf(w_o, w_i)));
      }
    }
  }
}

// A white base under any coat reflects all light.
TEST(CoatedDiffuse, PassesTheWhiteFurnaceWithAWhiteBase) {
  for (const double alpha : {0.1, 0.3, 0.6, 1.0}) {
    const CoatedDiffuse glazed(Color::Ones(), 1.5, alpha);
    for (const double cosine : kCosines) {
      // Grazing lobes need a fine grid.
      EXPECT_NEAR(DirectionalAlbedo(glazed, Towards(cosine), cosine < 0.1 ? 1200 : 256).x(), 1,
                  0.01)
          << alpha << " " << cosine;
    }
  }
}

// A smooth coat reflects the Fresnel reflectance in the mirror direction; the base scatters the
// rest.
TEST(CoatedDiffuse, ConvergesToAMirrorOverADiffuseBaseAtLowRoughness) {
  const Color red(0.8, 0.2, 0.1);
  const Color F0 = Color::Constant(0.04);
  // Mean of Schlick's F over the cosine-weighted hemisphere: F0 + (1 - F0) 2 / 42.
  const double mean = 0.04 + 0.96 / 21;
  for (const double alpha : {1e-2, 1e-3, 0.0}) {
    const CoatedDiffuse glazed(red, 1.5, alpha);
    for (const double v : {1.0, 0.5, 0.2}) {
      EXPECT_NEAR(glazed.CoatReflectance(v), SchlickFresnel(F0, v).x(), 0.004) << alpha << " " << v;
      // Far from the mirror direction only the base is visible.
      const double l = v < 0.9 ? 0.97 : 0.3;
      const Color base =
          red * (1 - SchlickFresnel(F0, v)) * (1 - SchlickFresnel(F0, l)) / (pi * (1 - mean));
      EXPECT_LT((glazed.Eval(Towards(v), Towards(l)) - base).abs().maxCoeff(), 0.01 * base.x());
    }
  }
}

TEST(CoatedDiffuse, IsFiniteAtGrazingAngles) {
  for (const double alpha : {0.0, 1e-3, 0.1, 1.0}) {
    const CoatedDiffuse glazed(Color::Ones(), 1.5, alpha);
    for (const double v : {1e-4, 1e-8, 1e-16, 1e-300}) {
      const Vector3d w_o = Towards(v);
      // By Schlick the coat reflects all grazing light.
      EXPECT_LE(glazed.CoatReflectance(v), 1.005) << alpha << " " << v;
      for (const double l : {1.0, 1e-4, 1e-16, 1e-300}) {
        const Vector3d w_i(-std::sqrt(1 - l * l), 0, l);
        EXPECT_TRUE((glazed.Eval(w_o, w_i) * l).isFinite().all()) << alpha << " " << v << " " << l;
        EXPECT_TRUE(std::isfinite(glazed.Pdf(w_o, w_i)));
      }
      for (std::uint64_t i = 0; i < 200; ++i) {
        const auto sample = glazed.Sample(w_o, test::Uniform3(5, i));
        if (!sample) continue;
        ASSERT_GT(sample->pdf, 0) << alpha << " " << v;
        ASSERT_TRUE((sample->f * (sample->w_i.z() / sample->pdf)).isFinite().all());
      }
    }
  }
}

TEST(CoatedDiffuse, IsLambertianWithoutACoat) {
  const Color red(0.8, 0.2, 0.1);
  const CoatedDiffuse bare(red, 1.0 + 1e-9, 0.5);
  // By Schlick the coat still reflects at grazing angles, hence nearly normal incidence.
  const Color f = bare.Eval(Towards(1), Towards(0.95));
  EXPECT_LT((f - red / pi).abs().maxCoeff(), 0.06 * red.x() / pi);
}

TEST(Lambert, ReflectsItsAlbedo) {
  const Color red(0.8, 0.2, 0.1);
  EXPECT_TRUE(DirectionalAlbedo(Lambert(red), Towards(0.3)).isApprox(red, 1e-9));
}

}  // namespace
}  // namespace nerf
