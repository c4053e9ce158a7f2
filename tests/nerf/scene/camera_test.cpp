#include "nerf/scene/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

namespace nerf {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

struct Lens {
  std::string name;
  Camera camera;
};
void PrintTo(const Lens& lens, std::ostream* out) { *out << lens.name; }

Camera Make(CameraModel model, std::vector<double> params, int width = 200, int height = 140) {
  return {model, width, height, std::move(params)};
}

// Every pixel of these images has a direction.
std::vector<Lens> LensesThatFillTheirImage() {
  using M = CameraModel;
  return {
      {"SimplePinhole", Make(M::kSimplePinhole, {150, 98, 71})},
      {"Pinhole", Make(M::kPinhole, {150, 160, 98, 71})},
      {"SimpleRadialMild", Make(M::kSimpleRadial, {150, 98, 71, 0.05})},
      {"SimpleRadialBarrel", Make(M::kSimpleRadial, {150, 98, 71, -0.15})},
      {"SimpleRadialPincushion", Make(M::kSimpleRadial, {60, 98, 71, 0.8})},
      {"RadialMild", Make(M::kRadial, {150, 98, 71, -0.05, 0.01})},
      {"RadialStrong", Make(M::kRadial, {90, 98, 71, -0.3, 0.12})},
      {"OpenCVMild", Make(M::kOpenCV, {150, 160, 98, 71, -0.05, 0.01, 0.001, -0.002})},
      {"OpenCVStrong", Make(M::kOpenCV, {90, 95, 98, 71, -0.28, 0.11, 0.01, -0.015})},
      {"Fox", Make(M::kOpenCV,
                   {1375.52 / 8, 1374.49 / 8, 554.558 / 8, 965.268 / 8, 0.0578421, -0.0805099,
                    -0.000980296, 0.00015575},
                   135, 240)},
      {"OpenCVFisheyeMild", Make(M::kOpenCVFisheye, {100, 101, 98, 71, 0.01, -0.004, 0.001, 0})},
      {"OpenCVFisheyeWide",
       Make(M::kOpenCVFisheye, {55, 55, 98, 71, 0.03, -0.006, 0.0009, -0.00004})},
      {"FullOpenCVMild", Make(M::kFullOpenCV, {150, 160, 98, 71, 0.1, -0.03, 0.001, -0.002, 0.004,
                                               0.12, -0.02, 0.003})},
      {"FullOpenCVStrong",
       Make(M::kFullOpenCV, {80, 85, 98, 71, 0.6, 0.3, 0.004, -0.003, 0.05, 0.9, 0.4, 0.08})},
      {"FovMild", Make(M::kFov, {150, 160, 98, 71, 0.3})},
      {"FovStrong", Make(M::kFov, {110, 112, 98, 71, 1.2})},
      {"FovWithoutAngle", Make(M::kFov, {150, 160, 98, 71, 0.0})},
      {"SimpleRadialFisheyeMild", Make(M::kSimpleRadialFisheye, {120, 98, 71, 0.02})},
      {"SimpleRadialFisheyeWide", Make(M::kSimpleRadialFisheye, {45, 98, 71, 0.01})},
      {"RadialFisheyeMild", Make(M::kRadialFisheye, {120, 98, 71, 0.02, -0.003})},
      {"RadialFisheyeWide", Make(M::kRadialFisheye, {50, 98, 71, -0.02, 0.003})},
      {"ThinPrismFisheyeMild", Make(M::kThinPrismFisheye, {120, 121, 98, 71, 0.02, -0.003, 0.001,
                                                           -0.002, 0.0005, 0, 0.001, -0.001})},
      {"ThinPrismFisheyeWide", Make(M::kThinPrismFisheye, {60, 61, 98, 71, -0.03, 0.006, 0.004,
                                                           -0.003, 0.0003, 0, 0.006, 0.004})},
  };
}

class EveryLens : public testing::TestWithParam<Lens> {};
INSTANTIATE_TEST_SUITE_P(Camera, EveryLens, testing::ValuesIn(LensesThatFillTheirImage()),
                         [](const auto& test) { return test.param.name; });

TEST_P(EveryLens, ProjectsADirectionBackToItsPixel) {
  const Camera& camera = GetParam().camera;
  for (int y = 0; y <= camera.height; y += 2) {
    for (int x = 0; x <= camera.width; x += 2) {
      const Vector2d pixel(x + 0.25, y + 0.5);
      const auto direction = DirectionFromPixel(camera, pixel);
      ASSERT_TRUE(direction) << pixel.transpose();
      ASSERT_NEAR(direction->norm(), 1, 1e-12) << pixel.transpose();
      const auto back = PixelFromPoint(camera, *direction * 3.7);
      ASSERT_TRUE(back) << pixel.transpose();
      ASSERT_LT((*back - pixel).norm(), 1e-7) << pixel.transpose() << " -> " << back->transpose();
    }
  }
}

TEST_P(EveryLens, LooksStraightAheadThroughThePrincipalPoint) {
  const Camera& camera = GetParam().camera;
  const auto ahead = DirectionFromPixel(camera, PrincipalPoint(camera));
  ASSERT_TRUE(ahead);
  EXPECT_LT((*ahead - Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((*PixelFromPoint(camera, {0, 0, 2}) - PrincipalPoint(camera)).norm(), 1e-9);
}

TEST_P(EveryLens, ProjectsNoPointBehindItNorItsCentre) {
  const Camera& camera = GetParam().camera;
  EXPECT_FALSE(PixelFromPoint(camera, {0, 0, -1}));
  EXPECT_FALSE(PixelFromPoint(camera, {0, 0, 0}));
}

TEST_P(EveryLens, KeepsPixelsDistinct) {
  // Directions keep the orientation of pixels: x to the right, y down.
  const Camera& camera = GetParam().camera;
  for (int y = 1; y < camera.height; y += 7) {
    for (int x = 1; x < camera.width; x += 7) {
      const Vector3d here = *DirectionFromPixel(camera, {x, y});
      const Vector3d right = *DirectionFromPixel(camera, {x + 0.01, y});
      const Vector3d below = *DirectionFromPixel(camera, {x, y + 0.01});
      ASSERT_GT((right - here).cross(below - here).dot(here), 0) << x << ", " << y;
    }
  }
}

TEST_P(EveryLens, DownscalesWithItsImage) {
  const Camera& camera = GetParam().camera;
  const Camera small = Downscaled(camera, 3);
  EXPECT_EQ(small.width, camera.width / 3);
  EXPECT_EQ(small.height, camera.height / 3);
  for (const Vector3d& x : {Vector3d(0.1, -0.2, 1), Vector3d(-0.3, 0.15, 1)}) {
    EXPECT_LT((*PixelFromPoint(small, x) * 3 - *PixelFromPoint(camera, x)).norm(), 1e-9);
  }
}

TEST_P(EveryLens, RefusesNaN) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Camera& camera = GetParam().camera;
  EXPECT_FALSE(DirectionFromPixel(camera, {kNan, 3}));
  EXPECT_FALSE(PixelFromPoint(camera, {kNan, 1, 1}));
  EXPECT_FALSE(PixelFromPoint(camera, {1, 1, kNan}));
}

TEST(CropRows, KeepsTheDirectionsOfItsPixels) {
  for (const Lens& lens : LensesThatFillTheirImage()) {
    const Camera rows = CropRows(lens.camera, 40, 20);
    EXPECT_EQ(rows.width, lens.camera.width);
    EXPECT_EQ(rows.height, 20);
    const auto whole = DirectionFromPixel(lens.camera, {30.5, 47.5});
    const auto part = DirectionFromPixel(rows, {30.5, 7.5});
    ASSERT_TRUE(whole && part) << lens.name;
    EXPECT_LT((*whole - *part).norm(), 1e-12) << lens.name;
  }
}

TEST(CropColumns, KeepsTheDirectionsOfItsPixels) {
  for (const Lens& lens : LensesThatFillTheirImage()) {
    const Camera columns = CropColumns(lens.camera, 20, 30);
    EXPECT_EQ(columns.width, 30);
    EXPECT_EQ(columns.height, lens.camera.height);
    const auto whole = DirectionFromPixel(lens.camera, {30.5, 47.5});
    const auto part = DirectionFromPixel(columns, {10.5, 47.5});
    ASSERT_TRUE(whole && part) << lens.name;
    EXPECT_LT((*whole - *part).norm(), 1e-12) << lens.name;
  }
}

TEST(Camera, TopLeftPixelLooksUpAndLeft) {
  const Camera camera = Make(CameraModel::kPinhole, {1, 1, 1, 1}, 2, 2);
  const Vector3d direction = *DirectionFromPixel(camera, {0.5, 0.5});
  EXPECT_LT((direction - Vector3d(-0.5, -0.5, 1).normalized()).norm(), 1e-12);
}

TEST(Camera, PerspectiveLensesProjectNothingBehindThem) {
  for (const Lens& lens : LensesThatFillTheirImage()) {
    if (lens.name.find("Fisheye") != std::string::npos) continue;
    EXPECT_FALSE(PixelFromPoint(lens.camera, {0.1, 0.1, -1})) << lens.name;
    EXPECT_FALSE(PixelFromPoint(lens.camera, {0.1, 0.1, 0})) << lens.name;
  }
}

TEST(Camera, FisheyesSeeBeyondNinetyDegrees) {
  const Camera camera = Make(CameraModel::kSimpleRadialFisheye, {30, 100, 70, 0.0});
  const double angle = 120 * kPi / 180;
  const Vector3d x(std::sin(angle), 0, std::cos(angle));
  const auto pixel = PixelFromPoint(camera, x);
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), 100 + 30 * angle, 1e-9);
  EXPECT_LT((*DirectionFromPixel(camera, *pixel) - x).norm(), 1e-12);
}

TEST(Camera, PixelsOutsideTheImageCircleOfAFisheyeHaveNoDirection) {
  const Camera camera = Make(CameraModel::kOpenCVFisheye, {30, 30, 100, 70, 0, 0, 0, 0});
  EXPECT_TRUE(DirectionFromPixel(camera, {100 + 30 * 3.14, 70}));
  EXPECT_FALSE(DirectionFromPixel(camera, {100 + 30 * 3.15, 70}));
}

TEST(Camera, APolynomialIsValidUpToItsMaximum) {
  // r - r^3 / 3 increases up to r = 1, where it is 2/3; farther points would fold back into the
  // image.
  const Camera camera = Make(CameraModel::kSimpleRadial, {90, 100, 70, -1.0 / 3});
  EXPECT_TRUE(DirectionFromPixel(camera, {100 + 90 * 0.6666, 70}));
  EXPECT_FALSE(DirectionFromPixel(camera, {100 + 90 * 0.6667, 70}));
  EXPECT_TRUE(PixelFromPoint(camera, {0.999, 0, 1}));
  EXPECT_FALSE(PixelFromPoint(camera, {1.001, 0, 1}));
  EXPECT_FALSE(PixelFromPoint(camera, {1.7, 0, 1}));
  EXPECT_FALSE(PixelFromPoint(camera, {20, 0, 1}));
}

TEST(Camera, ALensIsValidUpToItsFirstFold) {
  // r (1 - s + 0.3 s^2): its derivative 1 - 3 s + 1.5 s^2 is negative for s in (0.4226, 1.5774).
  const Camera camera = Make(CameraModel::kRadial, {100, 100, 70, -1.0, 0.3});
  EXPECT_TRUE(PixelFromPoint(camera, {std::sqrt(0.42), 0, 1}));
  EXPECT_FALSE(PixelFromPoint(camera, {std::sqrt(0.43), 0, 1}));
  EXPECT_FALSE(PixelFromPoint(camera, {2, 0, 1}));
  for (int x = 0; x <= 400; ++x) {
    const auto direction = DirectionFromPixel(camera, {x + 0.5, 70});
    if (!direction) continue;
    EXPECT_LT(std::abs(direction->x() / direction->z()), 0.6502) << x;
  }
}

TEST(Camera, ARationalLensIsValidUpToItsPole) {
  // r / (1 - 0.5 s): the pole is at s = 2.
  const Camera camera =
      Make(CameraModel::kFullOpenCV, {20, 20, 100, 70, 0, 0, 0, 0, 0, -0.5, 0, 0});
  EXPECT_TRUE(PixelFromPoint(camera, {1.41, 0, 1}));
  EXPECT_FALSE(PixelFromPoint(camera, {1.42, 0, 1}));
  const Vector3d far = *DirectionFromPixel(camera, {2000, 70});
  EXPECT_LT(far.x() / far.z(), std::sqrt(2.0));
}

TEST(Camera, HostileParametersGiveNoDirectionInsteadOfAHang) {
  constexpr double kHuge = 1e300;
  for (const double k : {kHuge, -kHuge, std::numeric_limits<double>::infinity(),
                         std::numeric_limits<double>::quiet_NaN()}) {
    const Camera camera = Make(CameraModel::kFullOpenCV, {100, 0, 50, 50, k, -k, k, k, k, k, k, k});
    EXPECT_FALSE(DirectionFromPixel(camera, {3, 4}));
    EXPECT_FALSE(PixelFromPoint(camera, {0.3, 0.2, 1}));
  }
}

TEST(Camera, FocalLengthIsTheMeanOfBoth) {
  EXPECT_DOUBLE_EQ(FocalLength(Make(CameraModel::kPinhole, {100, 120, 50, 40})), 110);
  EXPECT_DOUBLE_EQ(FocalLength(Make(CameraModel::kRadial, {100, 50, 40, 0, 0})), 100);
}

TEST(Camera, FieldOfViewSpansTheImage) {
  const Camera camera = PinholeFromFov(160, 90, 60 * kPi / 180);
  const Vector3d top = *DirectionFromPixel(camera, {80, 0});
  const Vector3d bottom = *DirectionFromPixel(camera, {80, 90});
  EXPECT_NEAR(std::acos(top.dot(bottom)), 60 * kPi / 180, 1e-12);
  EXPECT_EQ(camera.width, 160);
  EXPECT_DOUBLE_EQ(camera.params[0], camera.params[1]);
}

}  // namespace
}  // namespace nerf
