#include "nerf/reference/lens.h"

#include <cmath>
#include <utility>

namespace nerf::reference {
namespace {

using Plane = std::pair<double, double>;

Plane OpenCV(double u, double v, double k1, double k2, double p1, double p2) {
  const double r2 = u * u + v * v, radial = k1 * r2 + k2 * r2 * r2;
  return {u + u * radial + 2 * p1 * u * v + p2 * (r2 + 2 * u * u),
          v + v * radial + 2 * p2 * u * v + p1 * (r2 + 2 * v * v)};
}

// The image of a point of the ideal plane under an equidistant fisheye.
Plane Equidistant(double u, double v) {
  const double r = std::sqrt(u * u + v * v);
  if (r == 0) return {0, 0};
  const double theta = std::atan(r);
  return {u * theta / r, v * theta / r};
}

Plane Scaled(const Plane& m, double by) { return {m.first * by, m.second * by}; }

}  // namespace

std::array<double, 2> PixelFromPoint(const Camera& camera, const std::array<double, 3>& x) {
  using M = CameraModel;
  const double* p = camera.params.data();
  const double u = x[0] / x[2], v = x[1] / x[2], r2 = u * u + v * v;
  const Plane fish = Equidistant(u, v);
  const double t2 = fish.first * fish.first + fish.second * fish.second;
  const auto one_focal = [&](const Plane& m) -> std::array<double, 2> {
    return {p[0] * m.first + p[1], p[0] * m.second + p[2]};
  };
  const auto two_focals = [&](const Plane& m) -> std::array<double, 2> {
    return {p[0] * m.first + p[2], p[1] * m.second + p[3]};
  };
  switch (camera.model) {
    case M::kSimplePinhole:
      return one_focal({u, v});
    case M::kPinhole:
      return two_focals({u, v});
    case M::kSimpleRadial:
      return one_focal(Scaled({u, v}, 1 + p[3] * r2));
    case M::kRadial:
      return one_focal(Scaled({u, v}, 1 + p[3] * r2 + p[4] * r2 * r2));
    case M::kOpenCV:
      return two_focals(OpenCV(u, v, p[4], p[5], p[6], p[7]));
    case M::kOpenCVFisheye:
      return two_focals(Scaled(fish, 1 + p[4] * t2 + p[5] * std::pow(t2, 2) +
                                         p[6] * std::pow(t2, 3) + p[7] * std::pow(t2, 4)));
    case M::kFullOpenCV: {
      const double above = 1 + p[4] * r2 + p[5] * std::pow(r2, 2) + p[8] * std::pow(r2, 3);
      const double below = 1 + p[9] * r2 + p[10] * std::pow(r2, 2) + p[11] * std::pow(r2, 3);
      return two_focals({u * above / below + 2 * p[6] * u * v + p[7] * (r2 + 2 * u * u),
                         v * above / below + 2 * p[7] * u * v + p[6] * (r2 + 2 * v * v)});
    }
    case M::kFov: {
      const double r = std::sqrt(r2), omega = p[4];
      const bool bends = omega != 0 && r != 0;
      const double factor = bends ? std::atan(2 * r * std::tan(omega / 2)) / (r * omega)
                                  : (omega == 0 ? 1 : 2 * std::tan(omega / 2) / omega);
      return two_focals(Scaled({u, v}, factor));
    }
    case M::kSimpleRadialFisheye:
      return one_focal(Scaled(fish, 1 + p[3] * t2));
    case M::kRadialFisheye:
      return one_focal(Scaled(fish, 1 + p[3] * t2 + p[4] * t2 * t2));
    case M::kThinPrismFisheye: {
      const auto [a, b] = fish;
      const double radial =
          p[4] * t2 + p[5] * std::pow(t2, 2) + p[8] * std::pow(t2, 3) + p[9] * std::pow(t2, 4);
      return two_focals({a + a * radial + 2 * p[6] * a * b + p[7] * (t2 + 2 * a * a) + p[10] * t2,
                         b + b * radial + 2 * p[7] * a * b + p[6] * (t2 + 2 * b * b) + p[11] * t2});
    }
  }
  return {};
}

}  // namespace nerf::reference
