#pragma once

#include <array>

namespace nerf::reference {

using Vector3 = std::array<long double, 3>;

// Barron et al. 2022, equation 10, and its inverse.
Vector3 Contract(const Vector3& x);
Vector3 Uncontract(const Vector3& y);

// |J d|, with J the Jacobian of Contract in closed form and d a unit vector.
long double ContractedSpeed(const Vector3& x, const Vector3& d);

}  // namespace nerf::reference
