// The division of small products into blocks, for matrix_product.cpp and bfloat16_product.cpp.
// Compiled once for each SIMD level, as Highway includes both files.
#if defined(NERF_KERNELS_PRODUCT_BLOCKS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NERF_KERNELS_PRODUCT_BLOCKS_INL_H_
#undef NERF_KERNELS_PRODUCT_BLOCKS_INL_H_
#else
#define NERF_KERNELS_PRODUCT_BLOCKS_INL_H_
#endif

#include <hwy/highway.h>

#include "nerf/kernels/matrix_product.h"

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kRowPadding>;
using V = hn::Vec<D>;

template <Epilogue kEpilogue>
HWY_INLINE void Finish(V value, float* at) {
  const D d;
  if constexpr (kEpilogue == Epilogue::kAdd) value = hn::Add(hn::LoadU(d, at), value);
  // Not Max, which on x86 turns NaN into 0.
  if constexpr (kEpilogue == Epilogue::kStoreRelu) {
    value = hn::IfThenZeroElse(hn::Lt(value, hn::Zero(d)), value);
  }
  if constexpr (kEpilogue == Epilogue::kStoreMasked) {
    value = hn::IfThenElseZero(hn::Gt(hn::LoadU(d, at), hn::Zero(d)), value);
  }
  hn::StoreU(value, d, at);
}

// `Sum` defines the largest block of C that stays in registers (kMostRows, kMostVectors) and
// computes the sums of a block:
//   template <int kRows, int kVectors>
//   static void Of(const Product& p, int64 row, int64 column, V (&sum)[kRows][kVectors]);
template <class Sum, int kRows, int kVectors, Epilogue kEpilogue, class Product>
HWY_INLINE void Block(const Product& p, std::int64_t row, std::int64_t column) {
  const D d;
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
  V sum[kRows][kVectors];
  for (int r = 0; r < kRows; ++r) {
    for (int v = 0; v < kVectors; ++v) sum[r][v] = hn::Zero(d);
  }
  Sum::template Of<kRows, kVectors>(p, row, column, sum);
  for (int r = 0; r < kRows; ++r) {
    for (int v = 0; v < kVectors; ++v) {
      Finish<kEpilogue>(sum[r][v], p.c + (row + r) * p.c_row + column + v * lanes);
    }
  }
}

// The remaining rows, fewer than a block has.
template <class Sum, int kRows, int kVectors, Epilogue kEpilogue, class Product>
HWY_INLINE void LastRows(const Product& p, std::int64_t row, std::int64_t column) {
  if constexpr (kRows > 0) {
    if (p.rows - row == kRows) {
      Block<Sum, kRows, kVectors, kEpilogue>(p, row, column);
    } else {
      LastRows<Sum, kRows - 1, kVectors, kEpilogue>(p, row, column);
    }
  }
}

template <class Sum, int kVectors, Epilogue kEpilogue, class Product>
HWY_INLINE void Columns(const Product& p, std::int64_t column) {
  std::int64_t row = 0;
  for (; row + Sum::kMostRows <= p.rows; row += Sum::kMostRows) {
    Block<Sum, Sum::kMostRows, kVectors, kEpilogue>(p, row, column);
  }
  LastRows<Sum, Sum::kMostRows - 1, kVectors, kEpilogue>(p, row, column);
}

template <class Sum, Epilogue kEpilogue, class Product>
HWY_INLINE void AllColumns(const Product& p) {
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(D()));
  std::int64_t column = 0;
  for (; column + Sum::kMostVectors * lanes <= p.columns; column += Sum::kMostVectors * lanes) {
    Columns<Sum, Sum::kMostVectors, kEpilogue>(p, column);
  }
  for (; column < p.columns; column += lanes) Columns<Sum, 1, kEpilogue>(p, column);
}

template <class Sum, class Product>
HWY_INLINE void MultiplyInBlocks(const Product& p, Epilogue epilogue) {
  switch (epilogue) {
    case Epilogue::kStore:
      return AllColumns<Sum, Epilogue::kStore>(p);
    case Epilogue::kAdd:
      return AllColumns<Sum, Epilogue::kAdd>(p);
    case Epilogue::kStoreRelu:
      return AllColumns<Sum, Epilogue::kStoreRelu>(p);
    case Epilogue::kStoreMasked:
      return AllColumns<Sum, Epilogue::kStoreMasked>(p);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();

#endif
