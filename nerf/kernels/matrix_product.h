#pragma once

#include <cstdint>

namespace nerf::kernels {

// Rows are padded to multiples of this many floats, the longest vector, so that products need no
// remainder loop. The padding must be finite; zeros have no effect.
inline constexpr int kRowPadding = 16;
constexpr int PaddedWidth(int width) {
  return (width + kRowPadding - 1) / kRowPadding * kRowPadding;
}

// How a sum is written to C.
enum class Epilogue {
  kStore,       // C = A B
  kAdd,         // C += A B
  kStoreRelu,   // C = max(A B, 0)
  kStoreMasked  // C = A B where the old C was above 0, else 0: the backward pass of a ReLU
};

// A small product C [rows, columns] = A [rows, inner] B [inner, columns], in one thread.
//   a  element (r, k) at a[r * a_row + k * a_inner], so that A may be transposed
//   b  element (k, c) at b[k * b_row + c]
//   c  element (r, c) at c[r * c_row + c]
// columns is a multiple of kRowPadding. The order of the sum over k does not depend on the vector
// length, so that results differ between SIMD levels only by the rounding of fused products.
struct MatrixProduct {
  const float* a = nullptr;
  std::int64_t a_row = 0, a_inner = 1;
  const float* b = nullptr;
  std::int64_t b_row = 0;
  float* c = nullptr;
  std::int64_t c_row = 0;
  std::int64_t rows = 0, inner = 0, columns = 0;
};
void Multiply(const MatrixProduct& product, Epilogue epilogue);

}  // namespace nerf::kernels
