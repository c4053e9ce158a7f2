#pragma once

#include <cstdint>

#include "nerf/kernels/matrix_product.h"

namespace nerf::kernels {

// Products of matrices rounded to bfloat16 (a float of which the upper 16 bits are left, rounded to
// nearest even: a relative error of at most 2^-9 a factor), with sums in float. Processors that
// multiply bfloat16 by themselves (AVX512-BF16) do twice as many in the same time; on all others
// the same numbers come out, slower.
//
// Factors are stored as pairs along the sum: number 2k in the lower half of an integer, 2k + 1 in
// the upper.

// Whether this processor multiplies bfloat16 by itself.
bool HasBfloat16Products();

// Pairs of neighbours in a row.
//   from  [rows, columns], columns a multiple of kRowPadding, `row` floats apart    pairs  [rows,
//   columns / 2]
void PairColumns(const float* from, std::int64_t row, std::int64_t rows, std::int64_t columns,
                 std::uint32_t* pairs);

// Pairs of neighbours in a column. A last odd row is paired with zeros.
//   from  [rows, columns] likewise    pairs  [(rows + 1) / 2, columns]
void PairRows(const float* from, std::int64_t row, std::int64_t rows, std::int64_t columns,
              std::uint32_t* pairs);

// MatrixProduct of pairs: `inner` counts pairs, and so do the strides of a and b.
struct Bfloat16Product {
  const std::uint32_t* a = nullptr;
  std::int64_t a_row = 0, a_inner = 1;
  const std::uint32_t* b = nullptr;
  std::int64_t b_row = 0;
  float* c = nullptr;
  std::int64_t c_row = 0;
  std::int64_t rows = 0, inner = 0, columns = 0;
};
void Multiply(const Bfloat16Product& product, Epilogue epilogue);

}  // namespace nerf::kernels
