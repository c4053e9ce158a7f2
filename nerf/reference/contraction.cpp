#include "nerf/reference/contraction.h"

#include <cmath>

namespace nerf::reference {
namespace {

long double Dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

long double Norm(const Vector3& x) { return std::sqrt(Dot(x, x)); }

Vector3 Scaled(const Vector3& x, long double by) { return {by * x[0], by * x[1], by * x[2]}; }

}  // namespace

Vector3 Contract(const Vector3& x) {
  const long double r = Norm(x);
  return r <= 1 ? x : Scaled(x, (2 - 1 / r) / r);
}

Vector3 Uncontract(const Vector3& y) {
  const long double q = Norm(y);
  return q <= 1 ? y : Scaled(y, 1 / (q * (2 - q)));
}

// J = (2/r - 1/r^2) I + (2/r^2 - 2/r) n n^T, n = x / r.
long double ContractedSpeed(const Vector3& x, const Vector3& d) {
  const long double r = Norm(x);
  if (r <= 1) return Norm(d);
  const Vector3 n = Scaled(x, 1 / r);
  const long double plain = 2 / r - 1 / (r * r), along = 2 / (r * r) - 2 / r;
  Vector3 moved;
  for (int i = 0; i < 3; ++i) moved[i] = plain * d[i] + along * n[i] * Dot(n, d);
  return Norm(moved);
}

}  // namespace nerf::reference
