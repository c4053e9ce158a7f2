// Lens models and the sRGB transfer function.
#include <algorithm>
#include <cmath>
#include <limits>

#include "nerf/image/srgb.h"
#include "nerf/reference/lens.h"
#include "nerf/reference/srgb.h"
#include "nerf/scene/camera.h"
#include "nerf/selfcheck/numeric_case.h"

namespace nerf {
namespace {

using M = CameraModel;

// One rounding error of a pixel coordinate in an image of 200 x 140 pixels.
constexpr double kPixelRounding = 200 * kDoubleRounding;

// Each of COLMAP's models, distorting as strongly as real lenses do.
std::vector<Camera> Lenses() {
  return {
      {M::kSimplePinhole, 200, 140, {150, 98, 71}},
      {M::kPinhole, 200, 140, {150, 160, 98, 71}},
      {M::kSimpleRadial, 200, 140, {60, 98, 71, 0.8}},
      {M::kRadial, 200, 140, {90, 98, 71, -0.3, 0.12}},
      {M::kOpenCV, 200, 140, {90, 95, 98, 71, -0.28, 0.11, 0.01, -0.015}},
      {M::kOpenCVFisheye, 200, 140, {55, 55, 98, 71, 0.03, -0.006, 0.0009, -0.00004}},
      {M::kFullOpenCV, 200, 140, {80, 85, 98, 71, 0.6, 0.3, 0.004, -0.003, 0.05, 0.9, 0.4, 0.08}},
      {M::kFov, 200, 140, {110, 112, 98, 71, 1.2}},
      {M::kSimpleRadialFisheye, 200, 140, {45, 98, 71, 0.01}},
      {M::kRadialFisheye, 200, 140, {50, 98, 71, -0.02, 0.003}},
      {M::kThinPrismFisheye,
       200,
       140,
       {60, 61, 98, 71, -0.03, 0.006, 0.004, -0.003, 0.0003, 0, 0.006, 0.004}},
  };
}

double LensesFollowColmapsFormulae() {
  WorstError worst;
  for (const Camera& camera : Lenses()) {
    int compared = 0;
    for (double u = -0.9; u <= 0.9; u += 0.15) {
      for (double v = -0.6; v <= 0.6; v += 0.15) {
        const auto pixel = PixelFromPoint(camera, {2 * u, 2 * v, 2});
        if (!pixel) continue;  // outside the valid range of the model
        ++compared;
        const auto truth = reference::PixelFromPoint(camera, {2 * u, 2 * v, 2});
        worst.Add(std::max(std::fabs(pixel->x() - truth[0]), std::fabs(pixel->y() - truth[1])));
      }
    }
    worst.Require(compared > 80);  // of 117
  }
  return worst.Get();
}

double UndistortingInvertsDistorting() {
  WorstError worst;
  for (const Camera& camera : Lenses()) {
    const double focal = FocalLength(camera);
    int undone = 0;
    for (double y = 0; y <= camera.height; y += 5) {
      for (double x = 0; x <= camera.width; x += 5) {
        const auto direction = DirectionFromPixel(camera, {x, y});
        if (!direction) continue;  // outside the valid range of the model
        ++undone;
        const auto back = PixelFromPoint(camera, 3 * *direction);
        worst.Require(back.has_value());
        if (back) worst.Add((*back - Eigen::Vector2d(x, y)).norm() / focal);
        worst.Add(std::fabs(direction->norm() - 1));
      }
    }
    worst.Require(undone > 1000);
  }
  return worst.Get();
}

double LensesAreSmoothAtTheirAxis() {
  WorstError worst;
  for (const Camera& camera : Lenses()) {
    const Eigen::Vector2d centre = PrincipalPoint(camera);
    for (const double off : {0.0, 1e-300, 1e-12, 1e-6}) {
      const auto direction = DirectionFromPixel(camera, centre + Eigen::Vector2d(off, 0));
      worst.Require(direction.has_value());
      if (direction) {
        worst.Add(std::max(0.0, (*direction - Eigen::Vector3d::UnitZ()).norm() - off));
      }
      const auto pixel = PixelFromPoint(camera, {off, 0, 1});
      worst.Require(pixel.has_value());
      if (pixel) worst.Add(std::max(0.0, (*pixel - centre).norm() - 200 * off));
    }
  }
  return worst.Get();
}

double NothingIsMirroredFromBehind() {
  WorstError worst;
  for (const Camera& camera : Lenses()) {
    for (const double z : {0.0, -0.0, -1e-300, -1.0, -1e30}) {
      const auto pixel = PixelFromPoint(camera, {0.3, -0.2, z});
      if (!pixel) continue;
      // A fisheye may see points beside and behind it, but never on the wrong side of its axis.
      const Eigen::Vector2d from_centre = *pixel - PrincipalPoint(camera);
      worst.Require(from_centre.x() > 0 && from_centre.y() < 0);
    }
  }
  return worst.Get();
}

// The lengths include those at which squared norms underflow or overflow.
double PixelsDoNotDependOnHowFarAPointIs() {
  WorstError worst;
  for (const Camera& camera : Lenses()) {
    const auto truth = *PixelFromPoint(camera, {0.3, -0.2, 1});
    for (const double size : {1e-150, 1e-40, 1e-3, 1e30, 1e150}) {
      const auto pixel = PixelFromPoint(camera, {0.3 * size, -0.2 * size, size});
      worst.Require(pixel.has_value());
      if (pixel) worst.Add((*pixel - truth).norm());
    }
    worst.Require(!PixelFromPoint(camera, {0, 0, 0}).has_value());  // no direction, no pixel
  }
  return worst.Get();
}

double SrgbFollowsTheStandard() {
  WorstError worst;
  for (int i = -2000; i <= 8000; ++i) {
    const float linear = static_cast<float>(i) / 2000.0f;
    worst.AddRelative(SrgbFromLinear(linear), reference::SrgbFromLinear(linear), 1e-3L);
  }
  for (const float tiny : {0.0f, 1e-40f, 1e-20f, 1e-6f, -1e-6f, 0.0031308f, 0.0031309f}) {
    worst.AddRelative(SrgbFromLinear(tiny), reference::SrgbFromLinear(tiny), 1e-30L);
  }
  return worst.Get();
}

double SrgbRoundTripIsTheIdentity() {
  WorstError worst;
  for (int i = -2000; i <= 8000; ++i) {
    const float x = static_cast<float>(i) / 2000.0f;
    worst.AddRelative(LinearFromSrgb(SrgbFromLinear(x)), x, 1.0L);
  }
  // Slope 12.92 at 0, from both sides.
  constexpr float kStep = 1e-5f;
  worst.AddRelative((SrgbFromLinear(kStep) - SrgbFromLinear(-kStep)) / (2 * kStep), 12.92L);
  return worst.Get();
}

}  // namespace

std::vector<NumericCase> CameraCases() {
  return {
      {"LensesFollowColmapsFormulae", "pixels", Within(2.8e-13, 2.8e-14, kPixelRounding), false,
       LensesFollowColmapsFormulae},
      {"UndistortingInvertsDistorting", "pixels, parts of the focal length",
       Within(1.4e-14, 1.4e-15, kDoubleRounding), false, UndistortingInvertsDistorting},
      {"LensesAreSmoothAtTheirAxis", "direction, pixels", Within(1.5e-13, 0, kPixelRounding), false,
       LensesAreSmoothAtTheirAxis},
      {"NothingIsMirroredFromBehind", "mirrored or not", kExact, false,
       NothingIsMirroredFromBehind},
      {"PixelsDoNotDependOnHowFarAPointIs", "pixels", Within(1.5e-13, 1.4e-14, kPixelRounding),
       false, PixelsDoNotDependOnHowFarAPointIs},
      {"SrgbFollowsTheStandard", "relative", Within(6e-6, 6.8e-7), false, SrgbFollowsTheStandard},
      {"SrgbRoundTripIsTheIdentity", "colour, slope", Within(2e-6, 2.4e-7), false,
       SrgbRoundTripIsTheIdentity},
  };
}

}  // namespace nerf
