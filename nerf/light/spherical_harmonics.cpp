#include "nerf/light/spherical_harmonics.h"

#include <algorithm>
#include <numbers>

#include "nerf/geometry/directions.h"

namespace nerf {

using Eigen::Vector3d;

std::array<double, 9> SphericalHarmonics(const Vector3d& d) {
  return {0.28209479177387814,
          0.4886025119029199 * d.y(),
          0.4886025119029199 * d.z(),
          0.4886025119029199 * d.x(),
          1.0925484305920792 * d.x() * d.y(),
          1.0925484305920792 * d.y() * d.z(),
          0.31539156525252005 * (3 * d.z() * d.z() - 1),
          1.0925484305920792 * d.x() * d.z(),
          0.5462742152960396 * (d.x() * d.x() - d.y() * d.y())};
}

ShIrradiance::ShIrradiance(const EnvironmentMap& map) {
  using std::numbers::pi;
  coefficients_.fill(Color::Zero());
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const auto Y = SphericalHarmonics(map.Direction(x, y));
      const Color power = map.At(x, y) * map.SolidAngle(y);
      for (std::size_t i = 0; i < 9; ++i) coefficients_[i] += power * Y[i];
    }
  }
  for (std::size_t i = 0; i < 9; ++i) {
    coefficients_[i] *= i == 0 ? pi : i < 4 ? 2 * pi / 3 : pi / 4;
  }
}

Color ShIrradiance::At(const Vector3d& normal) const {
  const auto Y = SphericalHarmonics(normal);
  Color sum = Color::Zero();
  for (std::size_t i = 0; i < 9; ++i) sum += coefficients_[i] * Y[i];
  return sum;
}

ShError ShIrradianceError(const EnvironmentMap& map, int normals) {
  const ShIrradiance harmonics(map);
  ShError error;
  double sum = 0;
  for (int i = 0; i < normals; ++i) {
    const Vector3d normal = FibonacciDirection(i, normals);
    const Color truth = map.Irradiance(normal);
    const double difference = (harmonics.At(normal) - truth).abs().mean();
    sum += truth.mean();
    error.mean += difference;
    error.largest = std::max(error.largest, difference);
  }
  if (!(sum > 0)) return {};
  error.mean /= sum;
  error.largest /= sum / normals;
  return error;
}

}  // namespace nerf
