#include "nerf/reference/gaussians.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "nerf/kernels/gaussians.h"
#include "nerf/reference/lens.h"

namespace nerf::reference {
namespace {

Eigen::Vector2d PixelOf(const GaussianView& view, const Eigen::Vector3d& p) {
  const std::array<double, 2> pixel = PixelFromPoint(view.camera, {p.x(), p.y(), p.z()});
  return {pixel[0], pixel[1]};
}

Eigen::Matrix<double, 2, 3> JacobianAt(const GaussianView& view, const Eigen::Vector3d& p) {
  const double h = 1e-4 * p.norm();
  Eigen::Matrix<double, 2, 3> jacobian;
  for (int k = 0; k < 3; ++k) {
    // Of fourth order, since gradients of this are taken by differences again.
    const auto at = [&](double steps) {
      return PixelOf(view, p + steps * h * Eigen::Vector3d::Unit(k));
    };
    jacobian.col(k) = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h);
  }
  return jacobian;
}

Eigen::Vector3d ColorOf(const Gaussian& gaussian, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d d = direction.normalized();
  const double x = d.x(), y = d.y(), z = d.z(), xx = x * x, yy = y * y, zz = z * z;
  const double basis[16] = {0.28209479177387814,
                            -0.48860251190291987 * y,
                            0.48860251190291987 * z,
                            -0.48860251190291987 * x,
                            1.0925484305920792 * x * y,
                            -1.0925484305920792 * y * z,
                            0.94617469575755997 * zz - 0.31539156525251999,
                            -1.0925484305920792 * x * z,
                            0.54627421529603959 * (xx - yy),
                            0.59004358992664352 * y * (yy - 3 * xx),
                            2.8906114426405538 * x * y * z,
                            0.45704579946446572 * y * (1 - 5 * zz),
                            0.3731763325901154 * z * (5 * zz - 3),
                            0.45704579946446572 * x * (1 - 5 * zz),
                            1.4453057213202769 * z * (xx - yy),
                            0.59004358992664352 * x * (3 * yy - xx)};
  Eigen::Vector3d rgb = Eigen::Vector3d::Constant(0.5);
  for (std::size_t k = 0; k < gaussian.color.size(); ++k) rgb += basis[k] * gaussian.color[k];
  return rgb.cwiseMax(0);
}

}  // namespace

GaussianOnScreen Project(const Gaussian& gaussian, const GaussianView& view) {
  GaussianOnScreen on_screen;
  const Eigen::Vector3d p = view.camera_from_normalized * gaussian.mean;
  on_screen.distance = p.norm();
  if (p.z() <= view.near) return on_screen;
  const double opacity = kernels::kMostOpacity / (1 + std::exp(-gaussian.opacity));
  if (opacity <= kernels::kLeastAlpha) return on_screen;
  const double length = gaussian.rotation.norm();
  const Eigen::Vector4d q =
      length > 0 ? Eigen::Vector4d(gaussian.rotation / length) : Eigen::Vector4d(1, 0, 0, 0);
  const Eigen::Matrix3d axes = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix() *
                               gaussian.log_scale.array().exp().matrix().asDiagonal();
  const Eigen::Matrix<double, 2, 3> projected =
      JacobianAt(view, p) * view.camera_from_normalized.linear() * axes;
  const Eigen::Matrix2d covariance = projected * projected.transpose();
  on_screen.covariance =
      covariance + static_cast<double>(kernels::kPixelVariance) * Eigen::Matrix2d::Identity();
  const Eigen::Vector3d area =
      Eigen::Vector3d(projected.row(0)).cross(Eigen::Vector3d(projected.row(1)));
  on_screen.peak_share = std::sqrt(area.squaredNorm() / on_screen.covariance.determinant());
  on_screen.opacity = opacity * on_screen.peak_share;
  on_screen.mean = PixelOf(view, p);
  const Eigen::Vector3d seen_along =
      gaussian.mean - view.camera_from_normalized.inverse().translation();
  on_screen.rgb = ColorOf(gaussian, seen_along);
  Eigen::Index shortest = 0;
  gaussian.log_scale.minCoeff(&shortest);
  on_screen.normal = axes.col(shortest).normalized();
  if (on_screen.normal.dot(seen_along) > 0) on_screen.normal *= -1;
  on_screen.is_drawn = on_screen.opacity > 0;
  return on_screen;
}

std::vector<GaussianPixel> DrawGaussians(const std::vector<Gaussian>& gaussians,
                                         const GaussianView& view) {
  std::vector<GaussianOnScreen> drawn;
  for (const Gaussian& gaussian : gaussians) {
    const GaussianOnScreen on_screen = Project(gaussian, view);
    if (on_screen.is_drawn) drawn.push_back(on_screen);
  }
  std::ranges::stable_sort(drawn, {}, &GaussianOnScreen::distance);
  std::vector<GaussianPixel> pixels;
  for (int y = 0; y < view.camera.height; ++y) {
    for (int x = 0; x < view.camera.width; ++x) {
      GaussianPixel pixel;
      for (const GaussianOnScreen& g : drawn) {
        const Eigen::Vector2d offset = Eigen::Vector2d(x + 0.5, y + 0.5) - g.mean;
        const double alpha =
            g.opacity * std::exp(-0.5 * offset.dot(g.covariance.inverse() * offset));
        if (alpha < g.peak_share * kernels::kLeastAlpha) continue;
        const double weight = pixel.transmittance * alpha;
        pixel.rgb += weight * g.rgb;
        pixel.distance += weight * g.distance;
        pixel.normal += weight * g.normal;
        const double before = pixel.transmittance;
        pixel.transmittance -= weight;
        if (before >= 0.5 && pixel.transmittance < 0.5) pixel.median_distance = g.distance;
      }
      pixels.push_back(pixel);
    }
  }
  return pixels;
}

}  // namespace nerf::reference
