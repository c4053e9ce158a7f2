#pragma once

#include <array>
#include <span>

namespace nerf::kernels {

// The loss of a picture x against a photograph y, the sum over pixels and channels of
//   weight ((1 - s) sqrt((x - y)^2 + kCharbonnier^2) + s (1 - SSIM(x, y)))
// with SSIM over a Gaussian window of 11 x 11 pixels and a standard deviation of 1.5, beyond the
// border of the picture 0. It is computed row after row, in three passes, each of which needs rows
// of the one before: the caller divides the rows between threads.
// Source: Wang et al. 2004, "Image Quality Assessment"; Kerbl et al. 2023 (their combination).
inline constexpr float kCharbonnier = 0.03f;
inline constexpr int kWindowRadius = 5;

inline constexpr int kProducts = 5;
// First pass: x, x^2, x y, y and y^2 of a row, blurred horizontally. Pixels beyond the row are 0.
//   out  of a whole number of vectors, as all that is written
using ProductRows = std::array<std::span<float>, kProducts>;
void BlurProducts(std::span<const float> x, std::span<const float> y, const ProductRows& out);

// Rows around one, at [kWindowRadius]: rows beyond the picture are null.
struct RowsAround {
  const float* rows[2 * kWindowRadius + 1] = {};
};

// Second pass: the derivatives of the row's weighted SSIM by the blurred x, x^2 and x y, blurred
// horizontally.
//   products  of the first pass
//   weight    0 beyond the row
//   returns   the sum of weight SSIM
using DerivativeRows = std::array<std::span<float>, 3>;
double SimilarityDerivatives(const std::array<RowsAround, kProducts>& products,
                             std::span<const float> weight, const DerivativeRows& out);

// Third pass: the gradient by the row's x, written; 0 where the weight is 0.
//   derivatives  of the second pass
//   structural   s
//   returns      the sum of the first term, weight (1 - s) sqrt(...)
double PictureLossGradient(const std::array<RowsAround, 3>& derivatives, std::span<const float> x,
                           std::span<const float> y, std::span<const float> weight,
                           float structural, std::span<float> gradient);

}  // namespace nerf::kernels
