#include "nerf/field/direction_encoding.h"

namespace nerf {

torch::Tensor EncodeDirections(const torch::Tensor& directions) {
  TORCH_CHECK(directions.dim() == 2 && directions.size(1) == 3,
              "EncodeDirections: directions must be [R,3], got ", directions.sizes());
  const torch::Tensor x = directions.select(1, 0);
  const torch::Tensor y = directions.select(1, 1);
  const torch::Tensor z = directions.select(1, 2);
  const torch::Tensor xx = x * x, yy = y * y, zz = z * z;
  return torch::stack(
      {torch::full_like(x, 0.28209479177387814), -0.48860251190291987 * y, 0.48860251190291987 * z,
       -0.48860251190291987 * x, 1.0925484305920792 * x * y, -1.0925484305920792 * y * z,
       0.94617469575755997 * zz - 0.31539156525251999, -1.0925484305920792 * x * z,
       0.54627421529603959 * (xx - yy), 0.59004358992664352 * y * (-3.0 * xx + yy),
       2.8906114426405538 * x * y * z, 0.45704579946446572 * y * (1.0 - 5.0 * zz),
       0.3731763325901154 * z * (5.0 * zz - 3.0), 0.45704579946446572 * x * (1.0 - 5.0 * zz),
       1.4453057213202769 * z * (xx - yy), 0.59004358992664352 * x * (-xx + 3.0 * yy)},
      1);
}

}  // namespace nerf
