#include "nerf/kernels/matrix_product.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nerf/kernels/matrix_product.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

#include "nerf/kernels/product_blocks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {

// The sums of a block stay in registers: 6 rows of 4 vectors with the 32 registers of AVX-512, 6
// rows of 2 vectors with 16 registers.
struct FloatSum {
  static constexpr int kMostRows = 6;
  static constexpr int kMostVectors = HWY_TARGET <= HWY_AVX3 ? 4 : 2;

  template <int kRows, int kVectors>
  static HWY_INLINE void Of(const MatrixProduct& p, std::int64_t row, std::int64_t column,
                            V (&sum)[kRows][kVectors]) {
    const D d;
    const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
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
  }
};

void MultiplyImpl(const MatrixProduct& p, Epilogue epilogue) {
  MultiplyInBlocks<FloatSum>(p, epilogue);
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
