#include "nerf/kernels/bfloat16_product.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nerf/kernels/bfloat16_product.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

#include "nerf/kernels/product_blocks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {

using DU = hn::RebindToUnsigned<D>;
using VU = hn::Vec<DU>;

// The bits of a float, rounded to nearest even so that their upper half is the bfloat16.
template <class Tag, class Vector>
HWY_INLINE auto Rounded(Tag, Vector value) {
  const hn::RebindToUnsigned<Tag> du;
  const auto bits = hn::BitCast(du, value);
  const auto odd = hn::And(hn::ShiftRight<16>(bits), hn::Set(du, 1u));
  const auto rounded = hn::Add(bits, hn::Add(odd, hn::Set(du, 0x7fffu)));
  // NaN is truncated, since rounding could make it infinite; one bit is set to keep it NaN.
  const auto nan = hn::Or(bits, hn::Set(du, 0x400000u));
  return hn::IfThenElse(hn::RebindMask(du, hn::IsNaN(value)), nan, rounded);
}

template <class Tag, class Vector>
HWY_INLINE auto Paired(Tag d, Vector lower, Vector upper) {
  const hn::RebindToUnsigned<Tag> du;
  return hn::Or(hn::ShiftRight<16>(Rounded(d, lower)),
                hn::And(Rounded(d, upper), hn::Set(du, 0xffff0000u)));
}

void PairRowsImpl(const float* from, std::int64_t row, std::int64_t rows, std::int64_t columns,
                  std::uint32_t* pairs) {
  const D d;
  const DU du;
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
  for (std::int64_t r = 0; r < rows; r += 2) {
    const float* const lower = from + r * row;
    for (std::int64_t c = 0; c < columns; c += lanes) {
      const V upper = r + 1 < rows ? hn::LoadU(d, lower + row + c) : hn::Zero(d);
      hn::StoreU(Paired(d, hn::LoadU(d, lower + c), upper), du, pairs + c);
    }
    pairs += columns;
  }
}

void PairColumnsImpl(const float* from, std::int64_t row, std::int64_t rows, std::int64_t columns,
                     std::uint32_t* pairs) {
  // Rows are padded to multiples of two of these vectors.
  const hn::CappedTag<float, kRowPadding / 2> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
  for (std::int64_t r = 0; r < rows; ++r) {
    for (std::int64_t c = 0; c < columns; c += 2 * lanes) {
      hn::Vec<decltype(d)> even, odd;
      hn::LoadInterleaved2(d, from + r * row + c, even, odd);
      hn::StoreU(Paired(d, even, odd), du, pairs + r * (columns / 2) + c / 2);
    }
  }
}

// Two products per step: the even elements are in the lower halves of the pairs.
struct PairSum {
  static constexpr int kMostRows = 4;
  static constexpr int kMostVectors = 2;

  template <int kRows, int kVectors>
  static HWY_INLINE void Of(const Bfloat16Product& p, std::int64_t row, std::int64_t column,
                            V (&sum)[kRows][kVectors]) {
    const D d;
    const DU du;
    const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
    const VU upper = hn::Set(du, 0xffff0000u);
    for (std::int64_t k = 0; k < p.inner; ++k) {
      V even[kVectors], odd[kVectors];
      for (int v = 0; v < kVectors; ++v) {
        const VU pair = hn::LoadU(du, p.b + k * p.b_row + column + v * lanes);
        even[v] = hn::BitCast(d, hn::ShiftLeft<16>(pair));
        odd[v] = hn::BitCast(d, hn::And(pair, upper));
      }
      for (int r = 0; r < kRows; ++r) {
        const VU pair = hn::Set(du, p.a[(row + r) * p.a_row + k * p.a_inner]);
        const V a_even = hn::BitCast(d, hn::ShiftLeft<16>(pair));
        const V a_odd = hn::BitCast(d, hn::And(pair, upper));
        for (int v = 0; v < kVectors; ++v) {
          sum[r][v] = hn::MulAdd(a_odd, odd[v], hn::MulAdd(a_even, even[v], sum[r][v]));
        }
      }
    }
  }
};

// Whether native products may be used at the current SIMD level; tests select lower ones.
bool IsAvx512Impl() { return HWY_TARGET <= HWY_AVX3; }

void MultiplyImpl(const Bfloat16Product& p, Epilogue epilogue) {
  MultiplyInBlocks<PairSum>(p, epilogue);
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "nerf/kernels/bfloat16_native.h"

namespace nerf::kernels {
HWY_EXPORT(PairRowsImpl);
HWY_EXPORT(PairColumnsImpl);
HWY_EXPORT(MultiplyImpl);
HWY_EXPORT(IsAvx512Impl);

bool HasBfloat16Products() { return native::HasBfloat16() && HWY_DYNAMIC_DISPATCH(IsAvx512Impl)(); }

void PairColumns(const float* from, std::int64_t row, std::int64_t rows, std::int64_t columns,
                 std::uint32_t* pairs) {
  HWY_DYNAMIC_DISPATCH(PairColumnsImpl)(from, row, rows, columns, pairs);
}

void PairRows(const float* from, std::int64_t row, std::int64_t rows, std::int64_t columns,
              std::uint32_t* pairs) {
  HWY_DYNAMIC_DISPATCH(PairRowsImpl)(from, row, rows, columns, pairs);
}

void Multiply(const Bfloat16Product& product, Epilogue epilogue) {
  if (HasBfloat16Products()) return native::Multiply(product, epilogue);
  HWY_DYNAMIC_DISPATCH(MultiplyImpl)(product, epilogue);
}
}  // namespace nerf::kernels
#endif
