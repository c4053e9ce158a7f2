#include "nerf/kernels/bfloat16_native.h"

// Clang does not support #pragma GCC target.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)

#include <immintrin.h>

#pragma GCC push_options
#pragma GCC target("avx512f,avx512vl,avx512bw,avx512dq,avx512bf16")

namespace nerf::kernels::native {
namespace {

constexpr int kLanes = 16;
constexpr int kMostVectors = 4;
constexpr int kMostRows = 6;

template <Epilogue kEpilogue>
inline void Finish(__m512 value, float* at) {
  const __m512 zero = _mm512_setzero_ps();
  if constexpr (kEpilogue == Epilogue::kAdd) value = _mm512_add_ps(_mm512_loadu_ps(at), value);
  if constexpr (kEpilogue == Epilogue::kStoreRelu) {
    // NaN is not less than 0, so it is kept.
    value = _mm512_mask_mov_ps(value, _mm512_cmp_ps_mask(value, zero, _CMP_LT_OQ), zero);
  }
  if constexpr (kEpilogue == Epilogue::kStoreMasked) {
    value = _mm512_maskz_mov_ps(_mm512_cmp_ps_mask(_mm512_loadu_ps(at), zero, _CMP_GT_OQ), value);
  }
  _mm512_storeu_ps(at, value);
}

template <int kRows, int kVectors, Epilogue kEpilogue>
inline void Block(const Bfloat16Product& p, std::int64_t row, std::int64_t column) {
  __m512 sum[kRows][kVectors];
  for (int r = 0; r < kRows; ++r) {
    for (int v = 0; v < kVectors; ++v) sum[r][v] = _mm512_setzero_ps();
  }
  const std::uint32_t* a = p.a + row * p.a_row;
  const std::uint32_t* b = p.b + column;
  for (std::int64_t k = 0; k < p.inner; ++k) {
    __m512i b_k[kVectors];
    for (int v = 0; v < kVectors; ++v) b_k[v] = _mm512_loadu_si512(b + v * kLanes);
    for (int r = 0; r < kRows; ++r) {
      const __m512i a_k = _mm512_set1_epi32(static_cast<int>(a[r * p.a_row]));
      for (int v = 0; v < kVectors; ++v) {
        sum[r][v] = _mm512_dpbf16_ps(sum[r][v], (__m512bh)a_k, (__m512bh)b_k[v]);
      }
    }
    a += p.a_inner;
    b += p.b_row;
  }
  for (int r = 0; r < kRows; ++r) {
    for (int v = 0; v < kVectors; ++v) {
      Finish<kEpilogue>(sum[r][v], p.c + (row + r) * p.c_row + column + v * kLanes);
    }
  }
}

template <int kVectors, Epilogue kEpilogue>
inline void Columns(const Bfloat16Product& p, std::int64_t column) {
  std::int64_t row = 0;
  for (; row + kMostRows <= p.rows; row += kMostRows) {
    Block<kMostRows, kVectors, kEpilogue>(p, row, column);
  }
  for (; row + 2 <= p.rows; row += 2) Block<2, kVectors, kEpilogue>(p, row, column);
  for (; row < p.rows; ++row) Block<1, kVectors, kEpilogue>(p, row, column);
}

template <Epilogue kEpilogue>
void AllColumns(const Bfloat16Product& p) {
  std::int64_t column = 0;
  for (; column + kMostVectors * kLanes <= p.columns; column += kMostVectors * kLanes) {
    Columns<kMostVectors, kEpilogue>(p, column);
  }
  for (; column + 2 * kLanes <= p.columns; column += 2 * kLanes) Columns<2, kEpilogue>(p, column);
  for (; column < p.columns; column += kLanes) Columns<1, kEpilogue>(p, column);
}

}  // namespace

void Multiply(const Bfloat16Product& p, Epilogue epilogue) {
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

}  // namespace nerf::kernels::native

#pragma GCC pop_options

namespace nerf::kernels::native {
bool HasBfloat16() {
  static const bool has =
      __builtin_cpu_supports("avx512bf16") && __builtin_cpu_supports("avx512bw");
  return has;
}
}  // namespace nerf::kernels::native

#else

#include <cstdlib>

namespace nerf::kernels::native {
bool HasBfloat16() { return false; }
void Multiply(const Bfloat16Product&, Epilogue) { std::abort(); }
}  // namespace nerf::kernels::native

#endif
