#include "nerf/material/microfacet.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nerf/geometry/directions.h"

namespace nerf {

using Eigen::Vector3d;

Ggx::Ggx(double alpha) : alpha_(std::clamp(alpha, kMinAlpha, 1.0)) {}

double Ggx::NormalDensity(const Vector3d& h) const {
  // alpha^2 / (pi (cos^2 (alpha^2 - 1) + 1)^2) with 1 - cos^2 written as x^2 + y^2, which avoids
  // cancellation in narrow lobes.
  const double a2 = alpha_ * alpha_;
  const double spread = h.x() * h.x() + h.y() * h.y() + a2 * h.z() * h.z();
  return a2 / (std::numbers::pi * spread * spread);
}

double Ggx::Visibility(double n_dot_l, double n_dot_v) const {
  const double a2 = alpha_ * alpha_;
  const double l = n_dot_v * std::sqrt(a2 + (1 - a2) * n_dot_l * n_dot_l);
  const double v = n_dot_l * std::sqrt(a2 + (1 - a2) * n_dot_v * n_dot_v);
  return 0.5 / std::max(l + v, 1e-300);
}

double Ggx::Masking(double n_dot_w) const {
  const double a2 = alpha_ * alpha_;
  return 2 * n_dot_w / (n_dot_w + std::sqrt(a2 + (1 - a2) * n_dot_w * n_dot_w));
}

Vector3d Ggx::SampleVisibleNormal(const Vector3d& w_o, const Eigen::Array2d& u) const {
  // Stretch, so that the visible normals are those of a hemisphere, whose projection is a disc.
  const Vector3d v = Vector3d(alpha_ * w_o.x(), alpha_ * w_o.y(), w_o.z()).normalized();
  const double across = v.x() * v.x() + v.y() * v.y();
  const Vector3d t1 =
      across > 0 ? Vector3d(Vector3d(-v.y(), v.x(), 0) / std::sqrt(across)) : Vector3d::UnitX();
  const Vector3d t2 = v.cross(t1);
  const double r = std::sqrt(u.x());
  const double phi = 2 * std::numbers::pi * u.y();
  const double p1 = r * std::cos(phi);
  const double s = 0.5 * (1 + v.z());
  const double p2 = (1 - s) * std::sqrt(1 - p1 * p1) + s * r * std::sin(phi);
  const Vector3d h = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1 - p1 * p1 - p2 * p2)) * v;
  return Vector3d(alpha_ * h.x(), alpha_ * h.y(), std::max(1e-12, h.z())).normalized();
}

double Ggx::MirroredPdf(const Vector3d& w_o, const Vector3d& w_i) const {
  if (w_o.z() <= 0 || w_i.z() <= 0) return 0;
  const Vector3d h = HalfVector(w_o, w_i);
  return Masking(w_o.z()) * NormalDensity(h) / (4 * w_o.z());
}

std::optional<Vector3d> FacetsOverBase::Sample(const Vector3d& w_o, const Eigen::Array3d& u) const {
  if (w_o.z() <= 0) return std::nullopt;
  Vector3d w_i;
  if (u.z() < probability) {
    const Vector3d h = facets.SampleVisibleNormal(w_o, u.head<2>());
    w_i = (2 * w_o.dot(h) * h - w_o).normalized();
  } else {
    w_i = CosineOnHemisphere(u.head<2>());
  }
  if (w_i.z() <= 0) return std::nullopt;
  return w_i;
}

double FacetsOverBase::Pdf(const Vector3d& w_o, const Vector3d& w_i) const {
  if (w_o.z() <= 0 || w_i.z() <= 0) return 0;
  return probability * facets.MirroredPdf(w_o, w_i) +
         (1 - probability) * w_i.z() / std::numbers::pi;
}

Color SchlickFresnel(const Color& F0, double cosine) {
  const double m = 1 - std::clamp(cosine, 0.0, 1.0);
  return F0 + (1 - F0) * (m * m * m * m * m);
}

Color Conductor::Eval(const Vector3d& w_o, const Vector3d& w_i) const {
  if (w_o.z() <= 0 || w_i.z() <= 0) return Color::Zero();
  const Vector3d h = HalfVector(w_o, w_i);
  return SchlickFresnel(F0_, h.dot(w_i)) *
         (facets_.NormalDensity(h) * facets_.Visibility(w_i.z(), w_o.z()));
}

std::optional<BrdfSample> Conductor::Sample(const Vector3d& w_o, const Eigen::Array3d& u) const {
  if (w_o.z() <= 0) return std::nullopt;
  const Vector3d h = facets_.SampleVisibleNormal(w_o, u.head<2>());
  const Vector3d w_i = (2 * w_o.dot(h) * h - w_o).normalized();
  if (w_i.z() <= 0) return std::nullopt;
  return BrdfSample{w_i, Eval(w_o, w_i), Pdf(w_o, w_i)};
}

double Conductor::Pdf(const Vector3d& w_o, const Vector3d& w_i) const {
  return facets_.MirroredPdf(w_o, w_i);
}

}  // namespace nerf
