#include "nerf/transport/subsurface.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "nerf/base/parallel.h"
#include "nerf/geometry/directions.h"

namespace nerf {
namespace {

using Eigen::Vector3d;

using std::numbers::pi;
constexpr int kPoints = 1000;
constexpr double kLookupRadius = 2.5;  // relative to the mean distance of neighbouring points

// The mean of R_d over the patch of a point, a disc of radius rho about it. R_d is steep there, so
// that its value at the centre would not do; uses rings of equal area.
Color MeanOverOwnPatch(const Dipole& dipole, double rho) {
  constexpr int kRings = 64;
  Color sum = Color::Zero();
  for (int i = 0; i < kRings; ++i) {
    sum += dipole.DiffuseReflectance(rho * std::sqrt((i + 0.5) / kRings));
  }
  return sum / kRings;
}

}  // namespace

SubsurfaceSphere::SubsurfaceSphere(const Sphere& sphere, const Medium& medium)
    : sphere_(sphere), dipole_(medium), spread_(std::size_t{kPoints} * kPoints) {
  const double patch = 4 * pi * sphere.radius * sphere.radius / kPoints;
  for (int i = 0; i < kPoints; ++i) normals_.push_back(FibonacciDirection(i, kPoints));
  const Color own = MeanOverOwnPatch(dipole_, std::sqrt(patch / pi)) * patch;
  ParallelForEach(kPoints, [&](std::int64_t to) {
    for (int from = 0; from < kPoints; ++from) {
      const double r = sphere_.radius * (normals_[static_cast<std::size_t>(to)] -
                                         normals_[static_cast<std::size_t>(from)])
                                            .norm();
      const Color share = from == to ? own : Color(dipole_.DiffuseReflectance(r) * patch);
      spread_[static_cast<std::size_t>(to) * kPoints + from] = share.cast<float>();
    }
  });
}

SubsurfaceSphere::Exitance SubsurfaceSphere::Illuminate(
    std::shared_ptr<const SubsurfaceSphere> sphere,
    const std::function<Color(int, const Vector3d&, const Vector3d&)>& irradiance) {
  std::vector<Eigen::Array3f> incident(kPoints);
  ParallelForEach(kPoints, [&](std::int64_t i) {
    const auto at = static_cast<std::size_t>(i);
    const Vector3d& normal = sphere->normals_[at];
    const Vector3d x = sphere->sphere_.center + sphere->sphere_.radius * normal;
    incident[at] = irradiance(static_cast<int>(i), x, normal).cast<float>();
  });
  Exitance exitance;
  exitance.values_.resize(kPoints);
  for (std::size_t to = 0; to < kPoints; ++to) {
    Eigen::Array3f sum = Eigen::Array3f::Zero();
    for (std::size_t from = 0; from < kPoints; ++from) {
      sum += sphere->spread_[to * kPoints + from] * incident[from];
    }
    exitance.values_[to] = sum.cast<double>();
  }
  exitance.sphere_ = std::move(sphere);
  return exitance;
}

Color SubsurfaceSphere::UniformReflectance() const {
  Color sum = Color::Zero();
  for (std::size_t from = 0; from < kPoints; ++from) sum += spread_[from].cast<double>();
  return sum;
}

Color SubsurfaceSphere::Exitance::At(const Vector3d& x_in_world) const {
  // Weighted mean of the nearby points with weights (1 - d^2 / radius^2)^2, d^2 = 2 - 2 cos.
  const Vector3d normal = (x_in_world - sphere_->sphere_.center).normalized();
  const double radius2 = kLookupRadius * kLookupRadius * 4 * pi / kPoints;
  Color sum = Color::Zero();
  double weights = 0;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const double near = 1 - (2 - 2 * normal.dot(sphere_->normals_[i])) / radius2;
    if (near <= 0) continue;
    sum += near * near * values_[i];
    weights += near * near;
  }
  return sum / weights;
}

Color SubsurfaceSphere::Exitance::Radiance(const Vector3d& x_in_world, double n_dot_v) const {
  return At(x_in_world) * (sphere_->dipole_.Transmittance(n_dot_v) / pi);
}

}  // namespace nerf
