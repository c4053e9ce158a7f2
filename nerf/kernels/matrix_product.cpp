#include "nerf/kernels/matrix_product.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nerf/kernels/matrix_product.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kRowPadding>;
using V = hn::Vec<D>;

// Vectors and rows of C that stay in registers while the sum runs: with AVX-512's 32 registers a
// 6 x 4 block, with 16 registers a 6 x 2 one.
constexpr int kMostVectors = HWY_TARGET <= HWY_AVX3 ? 4 : 2;
constexpr int kMostRows = 6;

template <int kRows, int kVectors, Epilogue kEpilogue>
HWY_INLINE void Block(const MatrixProduct& p, std::int64_t row, std::int64_t column) {
  const D d;
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
  V sum[kRows][kVectors];
  for (int r = 0; r < kRows; ++r) {
    for (int v = 0; v < kVectors; ++v) sum[r][v] = hn::Zero(d);
  }
  const float* a = p.a + row * p.a_row;
  const float* b = p.b + column;
  for (std::int64_t k = 0; k < p.inner; ++k) {
    V b_k[kVectors];
    for (int v = 0; v < kVectors; ++v) b_k[v] = hn::LoadU(d, b + v * lanes);
    for (int r = 0; r < kRows; ++r) {
      const V a_k = hn::Set(d, a[r * p.a_row]);
      for (int v = 0; v < kVectors; ++v) sum[r][v] = hn::MulAdd(a_k, b_k[v], sum[r][v]);
    }
    a += p.a_inner;
    b += p.b_row;
  }
  for (int r = 0; r < kRows; ++r) {
    float* c = p.c + (row + r) * p.c_row + column;
    for (int v = 0; v < kVectors; ++v) {
      float* const at = c + v * lanes;
      V value = sum[r][v];
      if constexpr (kEpilogue == Epilogue::kAdd) value = hn::Add(hn::LoadU(d, at), value);
      // Not Max, which on x86 turns NaN into 0 and would hide it.
      if constexpr (kEpilogue == Epilogue::kStoreRelu) {
        value = hn::IfThenZeroElse(hn::Lt(value, hn::Zero(d)), value);
      }
      if constexpr (kEpilogue == Epilogue::kStoreMasked) {
        value = hn::IfThenElseZero(hn::Gt(hn::LoadU(d, at), hn::Zero(d)), value);
      }
      hn::StoreU(value, d, at);
    }
  }
}

template <int kVectors, Epilogue kEpilogue>
HWY_INLINE void Columns(const MatrixProduct& p, std::int64_t column) {
  std::int64_t row = 0;
  for (; row + kMostRows <= p.rows; row += kMostRows) {
    Block<kMostRows, kVectors, kEpilogue>(p, row, column);
  }
  switch (p.rows - row) {
    case 5:
      return Block<5, kVectors, kEpilogue>(p, row, column);
    case 4:
      return Block<4, kVectors, kEpilogue>(p, row, column);
    case 3:
      return Block<3, kVectors, kEpilogue>(p, row, column);
    case 2:
      return Block<2, kVectors, kEpilogue>(p, row, column);
    case 1:
      return Block<1, kVectors, kEpilogue>(p, row, column);
    default:
      return;
  }
}

template <Epilogue kEpilogue>
HWY_INLINE void AllColumns(const MatrixProduct& p) {
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(D()));
  std::int64_t column = 0;
  for (; column + kMostVectors * lanes <= p.columns; column += kMostVectors * lanes) {
    Columns<kMostVectors, kEpilogue>(p, column);
  }
  for (; column < p.columns; column += lanes) Columns<1, kEpilogue>(p, column);
}

void MultiplyImpl(const MatrixProduct& p, Epilogue epilogue) {
  switch (epilogue) {
    case Epilogue::kStore:
      return AllColumns<Epilogue::kStore>(p);
    case Epilogue::kAdd:
      return AllColumns<Epilogue::kAdd>(p);
    case Epilogue::kStoreRelu:
      return AllColumns<Epilogue::kStoreRelu>(p);
    case Epilogue::kStoreMasked:
      return AllColumns<Epilogue::kStoreMasked>(p);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nerf::kernels {
HWY_EXPORT(MultiplyImpl);
void Multiply(const MatrixProduct& product, Epilogue epilogue) {
  HWY_DYNAMIC_DISPATCH(MultiplyImpl)(product, epilogue);
}
}  // namespace nerf::kernels
#endif
