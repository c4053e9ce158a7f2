#include "nerf/kernels/descriptor_matching.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nerf/kernels/descriptor_matching.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<std::int32_t>;
using V = hn::Vec<D>;

// Two numbers of a descriptor, 16 bits each, as one of 32 bits: a vector has a pair of as many
// descriptors of B as it has lanes, and its product with the same pair of a descriptor of A is
// added to as many sums.
constexpr int kPairs = kDescriptorSize / 2;

// A block of products stays in registers: of 4 descriptors of A with 4 vectors of B with the 32
// registers of AVX-512, with 2 vectors with 16 registers.
constexpr int kRows = 4;
constexpr int kVectors = HWY_TARGET <= HWY_AVX3 ? 4 : 2;
// As many descriptors of A as stay in the first-level cache beside a block of B.
constexpr int kRowsAtOnce = 64;

// sum + a_low b_low + a_high b_high of each lane.
HWY_INLINE V AddPairProducts(V a, V b, V sum) {
  const D d;
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
  // There it adds the products of neighbours (vpmaddwd, vpdpwssd), and leaves the other sum alone.
  const hn::Repartition<std::int16_t, D> d16;
  V unused = hn::Zero(d);
  return hn::ReorderWidenMulAccumulate(d, hn::BitCast(d16, a), hn::BitCast(d16, b), sum, unused);
#else
  const auto low = [](V v) { return hn::ShiftRight<16>(hn::ShiftLeft<16>(v)); };
  const auto high = [](V v) { return hn::ShiftRight<16>(v); };
  (void)d;
  return hn::Add(sum, hn::Add(hn::Mul(low(a), low(b)), hn::Mul(high(a), high(b))));
#endif
}

struct Best {
  V product, second, index;
};

HWY_INLINE void Update(V product, V index, Best& best) {
  const auto better = hn::Gt(product, best.product);
  best.second = hn::Max(best.second, hn::Min(best.product, product));
  best.product = hn::Max(best.product, product);
  best.index = hn::IfThenElse(better, index, best.index);
}

// What was found so far, one number per lane: [vectors][3][lanes].
class BestOfVectors {
 public:
  explicit BestOfVectors(std::size_t vectors)
      : lanes_(hn::Lanes(D())), numbers_(vectors * 3 * lanes_) {}

  void Reset() { std::ranges::fill(numbers_, 0); }
  HWY_INLINE Best Load(std::size_t vector) const {
    const D d;
    const std::int32_t* at = &numbers_[vector * 3 * lanes_];
    return {hn::LoadU(d, at), hn::LoadU(d, at + lanes_), hn::LoadU(d, at + 2 * lanes_)};
  }
  HWY_INLINE void Store(std::size_t vector, const Best& best) {
    const D d;
    std::int32_t* at = &numbers_[vector * 3 * lanes_];
    hn::StoreU(best.product, d, at);
    hn::StoreU(best.second, d, at + lanes_);
    hn::StoreU(best.index, d, at + 2 * lanes_);
  }
  NearestTwo OfLane(std::size_t vector, std::size_t lane) const {
    const std::int32_t* at = &numbers_[vector * 3 * lanes_ + lane];
    if (at[0] == 0) return {};
    return {at[2 * lanes_], at[0], at[lanes_]};
  }
  NearestTwo OfAllLanes(std::size_t vector) const {
    NearestTwo nearest;
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
      const NearestTwo other = OfLane(vector, lane);
      if (other.product > nearest.product) {
        nearest = {other.index, other.product, std::max(nearest.product, other.second_product)};
      } else {
        nearest.second_product = std::max(nearest.second_product, other.product);
      }
    }
    return nearest;
  }

 private:
  std::size_t lanes_;
  std::vector<std::int32_t> numbers_;
};

std::int32_t Pair(const std::uint8_t* numbers) {
  return numbers[0] | (static_cast<std::int32_t>(numbers[1]) << 16);
}

// Descriptors as pairs, [vector][pair][lane]; the last ones are filled up with zeros, which are
// nobody's nearest.
std::vector<std::int32_t> InterleavedPairs(std::span<const std::uint8_t> descriptors,
                                           std::size_t vectors, std::size_t lanes) {
  std::vector<std::int32_t> pairs(vectors * kPairs * lanes);
  const std::size_t count = descriptors.size() / kDescriptorSize;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* const numbers = &descriptors[i * kDescriptorSize];
    std::int32_t* const to = &pairs[(i / lanes) * kPairs * lanes + i % lanes];
    for (int k = 0; k < kPairs; ++k) to[k * lanes] = Pair(numbers + 2 * k);
  }
  return pairs;
}

// The products of kRows descriptors of A with kVectors vectors of B.
HWY_INLINE void Multiply(const std::int32_t* a, const std::int32_t* b, std::size_t lanes,
                         V (&sum)[kRows][kVectors]) {
  const D d;
  for (auto& row : sum) {
    for (V& v : row) v = hn::Zero(d);
  }
  for (int k = 0; k < kPairs; ++k) {
    V b_k[kVectors];
    for (int v = 0; v < kVectors; ++v) b_k[v] = hn::LoadU(d, b + (v * kPairs + k) * lanes);
    for (int r = 0; r < kRows; ++r) {
      const V a_k = hn::Set(d, a[r * kPairs + k]);
      for (int v = 0; v < kVectors; ++v) sum[r][v] = AddPairProducts(a_k, b_k[v], sum[r][v]);
    }
  }
}

void FindNearestTwoImpl(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b,
                        std::span<NearestTwo> of_a, std::span<NearestTwo> of_b) {
  const D d;
  const std::size_t lanes = hn::Lanes(d), per_block = kVectors * lanes;
  const std::size_t count_a = of_a.size(), count_b = of_b.size();
  const std::size_t vectors = (count_b + per_block - 1) / per_block * kVectors;
  const std::vector<std::int32_t> packed_b = InterleavedPairs(b, vectors, lanes);
  std::vector<std::int32_t> packed_a(kRowsAtOnce * kPairs);
  BestOfVectors best_of_b(vectors), best_of_a(kRowsAtOnce);
  best_of_b.Reset();
  for (std::size_t first = 0; first < count_a; first += kRowsAtOnce) {
    const std::size_t rows = std::min<std::size_t>(kRowsAtOnce, count_a - first);
    std::ranges::fill(packed_a, 0);
    for (std::size_t i = 0; i < rows * kPairs; ++i) {
      packed_a[i] = Pair(&a[first * kDescriptorSize + 2 * i]);
    }
    best_of_a.Reset();
    for (std::size_t vector = 0; vector < vectors; vector += kVectors) {
      for (std::size_t row = 0; row < rows; row += kRows) {
        V sum[kRows][kVectors];
        Multiply(&packed_a[row * kPairs], &packed_b[vector * kPairs * lanes], lanes, sum);
        for (int r = 0; r < kRows; ++r) {
          Best best = best_of_a.Load(row + r);
          for (int v = 0; v < kVectors; ++v) {
            Update(sum[r][v], hn::Iota(d, static_cast<std::int32_t>((vector + v) * lanes)), best);
          }
          best_of_a.Store(row + r, best);
        }
        for (int v = 0; v < kVectors; ++v) {
          Best best = best_of_b.Load(vector + v);
          for (int r = 0; r < kRows; ++r) {
            Update(sum[r][v], hn::Set(d, static_cast<std::int32_t>(first + row + r)), best);
          }
          best_of_b.Store(vector + v, best);
        }
      }
    }
    for (std::size_t i = 0; i < rows; ++i) of_a[first + i] = best_of_a.OfAllLanes(i);
  }
  for (std::size_t j = 0; j < count_b; ++j) of_b[j] = best_of_b.OfLane(j / lanes, j % lanes);
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nerf::kernels {
HWY_EXPORT(FindNearestTwoImpl);
void FindNearestTwo(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b,
                    std::span<NearestTwo> of_a, std::span<NearestTwo> of_b) {
  HWY_DYNAMIC_DISPATCH(FindNearestTwoImpl)(a, b, of_a, of_b);
}
}  // namespace nerf::kernels
#endif
