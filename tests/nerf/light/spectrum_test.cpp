#include "nerf/light/spectrum.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "nerf/light/cie_1931.h"
#include "nerf/light/light_name.h"
#include "nerf/light/units.h"
#include "tests/support/input_error_of.h"

namespace nerf {
namespace {

using ::testing::HasSubstr;

Eigen::Vector2d Chromaticity(const Spectrum& spectrum) {
  const Eigen::Vector3d xyz = XyzFromSpectrum(spectrum);
  return xyz.head<2>() / xyz.sum();
}

int SampleAt(double nm) { return static_cast<int>((nm - Spectrum::kFirst) / Spectrum::kStep); }

TEST(MatchingFunctions, HaveEqualIntegralsAndAPeakAt555Nanometers) {
  const Eigen::Vector3d sums = XyzFromSpectrum(EqualEnergy());
  // The sums published by the CIE at 5 nm: 21.3714, 21.3714, 21.3715 times 5 nm.
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sums[c], 106.857, 0.02);
  EXPECT_EQ(MatchingFunctions()[SampleAt(555)][1], 1.0);
  for (const auto& values : MatchingFunctions()) EXPECT_LE(values[1], 1.0);
}

// Published chromaticities: CIE 015:2018, table T.3 (2 degrees).
TEST(Illuminant, HasThePublishedChromaticity) {
  EXPECT_LT((Chromaticity(EqualEnergy()) - Eigen::Vector2d(1.0 / 3, 1.0 / 3)).norm(), 1e-4);
  EXPECT_LT((Chromaticity(IlluminantA()) - Eigen::Vector2d(0.44758, 0.40745)).norm(), 1e-4);
  EXPECT_LT((Chromaticity(Daylight(6504)) - Eigen::Vector2d(0.31272, 0.32903)).norm(), 1e-4);
  EXPECT_LT((Chromaticity(Daylight(5003)) - Eigen::Vector2d(0.34567, 0.35851)).norm(), 1e-4);
  EXPECT_LT((Chromaticity(Daylight(7504)) - Eigen::Vector2d(0.29903, 0.31488)).norm(), 1e-4);
}

// The table of D65 of the CIE, relative to 100 at 560 nm.
TEST(Illuminant, D65MatchesThePublishedTable) {
  const Spectrum d65 = Daylight(6504);
  const double table[][2] = {{380, 49.9755}, {400, 82.7549}, {450, 117.008}, {500, 109.354},
                             {560, 100},     {600, 90.0062}, {700, 71.6091}, {780, 63.3828}};
  for (const auto& [nm, value] : table) EXPECT_NEAR(d65.values[SampleAt(nm)], value, 0.05) << nm;
}

TEST(BlackBody, FollowsPlanck) {
  // Ratio of two wavelengths, computed by hand at 5000 K: (450/600)^-5 expm1(x600)/expm1(x450).
  const double x450 = 1.438777e-2 / (450e-9 * 5000);
  const double x600 = 1.438777e-2 / (600e-9 * 5000);
  const double expected = std::pow(450.0 / 600, -5) * std::expm1(x600) / std::expm1(x450);
  const Spectrum body = BlackBody(5000);
  EXPECT_NEAR(body.values[SampleAt(450)] / body.values[SampleAt(600)], expected, 1e-9);
  EXPECT_NEAR(body.values[SampleAt(560)], 1, 1e-12);
  // Illuminant A is a black body of 2856 K with the current constants.
  EXPECT_LT((Chromaticity(BlackBody(2855.5)) - Chromaticity(IlluminantA())).norm(), 1e-4);
  for (const double value : BlackBody(100).values) EXPECT_TRUE(std::isfinite(value));
}

TEST(LightName, D65IsWhite) {
  const Color white = *ColorOfLight("D65");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1, 2e-3);
}

TEST(LightName, WarmLightsAreRedderAndAllHaveUnitLuminance) {
  const Color warm = *ColorOfLight("blackbody:3200");
  EXPECT_GT(warm.x(), warm.y());
  EXPECT_GT(warm.y(), warm.z());
  const Color sky = *ColorOfLight("blackbody:12000");
  EXPECT_GT(sky.z(), sky.x());
  for (const char* name : {"A", "E", "D40", "D50", "D65", "D250", "blackbody:1000"}) {
    EXPECT_NEAR(Luminance(*ColorOfLight(name)), 1, 1e-9) << name;
    EXPECT_GE(ColorOfLight(name)->minCoeff(), 0) << name;
  }
}

TEST(LightName, RejectsUnknownNamesAndTemperaturesOutOfRange) {
  for (const char* name : {"", "F2", "blackbody", "blackbody:", "blackbody:hot", "D", "D65x"}) {
    EXPECT_FALSE(ColorOfLight(name)) << name;
  }
  EXPECT_THAT(test::InputErrorOf([] { ColorOfLight("blackbody:5"); }), HasSubstr("1000 to"));
  EXPECT_THAT(test::InputErrorOf([] { ColorOfLight("D20"); }), HasSubstr("4000 to 25000"));
}

TEST(Units, MatchKnownValuesAndAreInvertible) {
  EXPECT_NEAR(PhotonEnergy(555), 3.5792e-19, 1e-22);
  Spectrum green;
  green.values[SampleAt(555)] = 2;
  EXPECT_NEAR(LuminousEfficacy(green), 683, 1e-9);
  // About 204 lm / W, depending on the limits of the integral; the inverse must be exact.
  const Spectrum day = Daylight(6504);
  EXPECT_NEAR(WattsFromLumens(LumensFromWatts(7, day), day), 7, 1e-12);
  EXPECT_NEAR(LuminousEfficacy(day), 204, 6);
  EXPECT_NEAR(CandelaFromLumens(4 * std::numbers::pi), 1, 1e-12);
  EXPECT_NEAR(LumensFromCandela(CandelaFromLumens(800)), 800, 1e-9);
  EXPECT_EQ(FactorFromStops(3), 8);
  EXPECT_EQ(LuminousEfficacy(Spectrum{}), 0);
}

}  // namespace
}  // namespace nerf
