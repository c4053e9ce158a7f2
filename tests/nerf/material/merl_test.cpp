#include "nerf/material/merl.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <numbers>

#include "nerf/base/atomic_file.h"
#include "nerf/geometry/directions.h"
#include "nerf/material/lambert.h"
#include "nerf/material/microfacet.h"
#include "tests/support/chi_square.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;

using std::numbers::pi;

TEST(RusinkiewiczAngles, ConvertToDirectionsAndBack) {
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const Eigen::Array3d u = test::Uniform3(5, i);
    const RusinkiewiczAngles angles{1.5 * u.x(), 1.5 * u.y() + 0.01, 3.1 * u.z() + 0.01};
    const auto [w_o, w_i] = DirectionsFromRusinkiewicz(angles);
    ASSERT_NEAR(w_o.norm(), 1, 1e-12);
    const RusinkiewiczAngles back = RusinkiewiczFromDirections(w_o, w_i);
    ASSERT_NEAR(back.theta_h, angles.theta_h, 1e-9);
    ASSERT_NEAR(back.theta_d, angles.theta_d, 1e-9);
    ASSERT_NEAR(back.phi_d, angles.phi_d, 1e-7);
  }
}

TEST(RusinkiewiczAngles, HaveAnUprightHalfVectorForMirroredDirections) {
  const RusinkiewiczAngles angles =
      RusinkiewiczFromDirections(Vector3d(0.6, 0, 0.8), Vector3d(-0.6, 0, 0.8));
  EXPECT_NEAR(angles.theta_h, 0, 1e-12);
  EXPECT_NEAR(angles.theta_d, std::asin(0.6), 1e-12);
}

TEST(MerlBrdf, IsCloseToTheTabulatedBrdfAfterWritingAndReading) {
  const test::ScratchFolder scratch;
  const Conductor copper(Color(0.95, 0.64, 0.54), 0.3);
  MerlBrdf::Tabulate(copper).Write(scratch.path() / "copper.binary");
  const MerlBrdf measured = MerlBrdf::Read(scratch.path() / "copper.binary");
  double sum = 0;
  int count = 0;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const Vector3d w_o = CosineOnHemisphere(test::Uniform3(1, i).head<2>());
    const Vector3d w_i = CosineOnHemisphere(test::Uniform3(2, i).head<2>());
    if (w_o.z() < 0.2 || w_i.z() < 0.2) continue;  // bins at the horizon are partly empty
    const Color truth = copper.Eval(w_o, w_i);
    const double error = ((measured.Eval(w_o, w_i) - truth) / truth).abs().maxCoeff();
    ASSERT_LT(error, 0.1);
    sum += error;
    ++count;
  }
  EXPECT_LT(sum / count, 0.005);
}

TEST(MerlBrdf, IsConstantForALambertianUpToTheHorizon) {
  const MerlBrdf measured = MerlBrdf::Tabulate(Lambert(Color(0.5, 0.3, 0.2)));
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Vector3d w_o = CosineOnHemisphere(test::Uniform3(1, i).head<2>());
    const Vector3d w_i = CosineOnHemisphere(test::Uniform3(2, i).head<2>());
    if (w_o.z() < 0.05 || w_i.z() < 0.05) continue;
    ASSERT_NEAR(measured.Eval(w_o, w_i).x(), 0.5 / pi, 1e-9);
  }
}

TEST(MerlBrdf, RejectsInvalidFilesByName) {
  const test::ScratchFolder scratch;
  const auto error = [&](const std::string& bytes) {
    const auto file = scratch.Write("a.binary", bytes);
    const std::string message = test::InputErrorOf([&] { MerlBrdf::Read(file); });
    EXPECT_THAT(message, HasSubstr(file.string()));
    return message;
  };
  const auto header = [](std::int32_t a, std::int32_t b, std::int32_t c) {
    const std::int32_t sizes[] = {a, b, c};
    return std::string(reinterpret_cast<const char*>(sizes), sizeof sizes);
  };
  EXPECT_THAT(error(""), HasSubstr("not a MERL BRDF"));
  EXPECT_THAT(error(header(90, 90, 360)), HasSubstr("90 x 90 x 360"));
  EXPECT_THAT(error(header(90, 90, 180) + std::string(1000, '\0')),
              AllOf(HasSubstr("1012 bytes"), HasSubstr("34992012")));
  std::string bytes = header(90, 90, 180) + std::string(34992000, '\0');
  const double nan = std::nan("");
  std::memcpy(bytes.data() + 12 + 8 * 7, &nan, sizeof nan);
  EXPECT_THAT(error(bytes), AllOf(HasSubstr("value 7"), HasSubstr("nan")));
  EXPECT_THAT(test::InputErrorOf([&] { MerlBrdf::Read(scratch.path() / "none.binary"); }),
              HasSubstr("none.binary"));
}

}  // namespace
}  // namespace nerf
