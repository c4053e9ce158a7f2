#include "nerf/splats/gaussian_camera.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "nerf/base/input_error.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

// Beyond the border of the picture the lens is evaluated as far as this times its half diagonal:
// there are the means of Gaussians that reach into it.
constexpr double kBeyondBorder = 1.3;
constexpr double kMostFitError = 0.5;  // pixels, at the border and beyond
constexpr int kBorderSamples = 16;     // of each side
constexpr double kMostFisheye = 0.99 * std::numbers::pi;

// Of a pixel without direction, outside the image circle: that of the last one on the way there
// from the principal point.
Eigen::Vector3d NearestDirection(const Camera& camera, const Eigen::Vector2d& pixel) {
  if (const auto direction = DirectionFromPixel(camera, pixel)) return *direction;
  const Eigen::Vector2d centre = PrincipalPoint(camera);
  Eigen::Vector3d last = Eigen::Vector3d::UnitZ();
  double inside = 0, outside = 1;
  for (int i = 0; i < 20; ++i) {
    const double middle = (inside + outside) / 2;
    const auto direction = DirectionFromPixel(camera, centre + middle * (pixel - centre));
    (direction ? inside : outside) = middle;
    if (direction) last = *direction;
  }
  return last;
}

// The largest |u| and |v|, or for fisheyes the largest angle, of the picture's border on the ideal
// plane.
Eigen::Vector2d ExtentOnIdealPlane(const Camera& camera, bool is_fisheye) {
  Eigen::Vector2d extent(0, 0);
  for (int i = 0; i <= kBorderSamples; ++i) {
    const double s = static_cast<double>(i) / kBorderSamples;
    const double w = camera.width, h = camera.height;
    for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(s * w, 0), Eigen::Vector2d(s * w, h),
                                         Eigen::Vector2d(0, s * h), Eigen::Vector2d(w, s * h)}) {
      const auto direction = NearestDirection(camera, pixel);
      if (is_fisheye) {
        const double angle = std::atan2(direction.head<2>().norm(), direction.z());
        extent = extent.cwiseMax(Eigen::Vector2d(angle, angle));
      } else {
        extent = extent.cwiseMax((direction.head<2>() / direction.z()).cwiseAbs());
      }
    }
  }
  return extent;
}

// The factor of a radius by a polynomial of its square, by least squares over [0, extent].
std::array<float, 5> FitRadial(const LensDistortion& lens, double extent, double focal) {
  constexpr int kSamples = 100;
  Eigen::MatrixXd powers(kSamples, 5);
  Eigen::VectorXd factors(kSamples);
  for (int i = 0; i < kSamples; ++i) {
    const double r = extent * (i + 0.5) / kSamples;
    const auto distorted = DistortedFromIdeal(lens, {r, 0});
    for (int k = 0; k < 5; ++k) powers(i, k) = std::pow(r * r, k);
    factors(i) = distorted ? distorted->x() / r : 1;
  }
  const Eigen::VectorXd fitted = powers.colPivHouseholderQr().solve(factors);
  const double error = (powers * fitted - factors).cwiseAbs().maxCoeff() * extent * focal;
  if (!(error < kMostFitError)) {
    throw InputError(
        "an FOV lens with omega {} is too wide for Gaussians (off by {:.1f} pixels); "
        "undistort the photographs, or render the field",
        lens.fov_omega.value_or(0), error);
  }
  std::array<float, 5> coefficients{};
  for (int k = 0; k < 5; ++k) coefficients[k] = static_cast<float>(fitted[k]);
  return coefficients;
}

}  // namespace

kernels::GaussianCamera MakeGaussianCamera(const Camera& camera,
                                           const Eigen::Isometry3d& normalized_from_camera,
                                           double near) {
  kernels::GaussianCamera made;
  const Eigen::Isometry3d inverse = normalized_from_camera.inverse();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) made.rotation[3 * i + j] = static_cast<float>(inverse(i, j));
    made.translation[i] = static_cast<float>(inverse(i, 3));
    made.center[i] = static_cast<float>(normalized_from_camera(i, 3));
  }
  const Eigen::Vector2f focal = FocalLengths(camera).cast<float>();
  const Eigen::Vector2f principal = PrincipalPoint(camera).cast<float>();
  made.fx = focal.x();
  made.fy = focal.y();
  made.cx = principal.x();
  made.cy = principal.y();
  made.width = camera.width;
  made.height = camera.height;
  made.near = static_cast<float>(near);

  const LensDistortion lens = LensOf(camera);
  made.is_fisheye = lens.is_fisheye;
  Eigen::Vector2d extent = kBeyondBorder * ExtentOnIdealPlane(camera, lens.is_fisheye);
  if (lens.is_fisheye) extent = extent.cwiseMin(kMostFisheye);
  // Not beyond the radius where the formula folds.
  while (!DistortedFromIdeal(lens, lens.is_fisheye ? Eigen::Vector2d(extent.x(), 0) : extent)) {
    extent *= 0.97;
  }
  made.most_ideal = {static_cast<float>(extent.x()), static_cast<float>(extent.y())};
  for (int k = 0; k < 5; ++k) made.numerator[k] = static_cast<float>(lens.numerator[k]);
  for (int k = 0; k < 4; ++k) made.denominator[k] = static_cast<float>(lens.denominator[k]);
  if (lens.fov_omega) made.numerator = FitRadial(lens, extent.norm(), FocalLength(camera));
  made.tangential = {static_cast<float>(lens.tangential.x()),
                     static_cast<float>(lens.tangential.y())};
  made.prism = {static_cast<float>(lens.prism.x()), static_cast<float>(lens.prism.y())};
  made.is_pinhole = made.numerator == std::array<float, 5>{1, 0, 0, 0, 0} &&
                    made.denominator == std::array<float, 4>{1, 0, 0, 0} &&
                    made.tangential == std::array<float, 2>{} &&
                    made.prism == std::array<float, 2>{};
  return made;
}

}  // namespace nerf
