#include "tests/benchmarks/machine_limits.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/benchmarks/machine_limits.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace nerf::benchmarks {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

float FusedMultiplyAddsImpl(std::int64_t repeats, std::int64_t& operations) {
  const hn::CappedTag<float, 16> d;
  constexpr int kChains = 12;  // more than latency times units
  hn::Vec<decltype(d)> sum[kChains];
  for (int i = 0; i < kChains; ++i) sum[i] = hn::Set(d, 0.001f * static_cast<float>(i));
  const auto a = hn::Set(d, 0.999f), b = hn::Set(d, 0.001f);
  for (std::int64_t r = 0; r < repeats; ++r) {
    for (int i = 0; i < kChains; ++i) sum[i] = hn::MulAdd(sum[i], a, b);
  }
  auto total = sum[0];
  for (int i = 1; i < kChains; ++i) total = hn::Add(total, sum[i]);
  operations = repeats * kChains * 2 * static_cast<std::int64_t>(hn::Lanes(d));
  return hn::GetLane(hn::SumOfLanes(d, total));
}

float SumEntriesImpl(std::span<const float> table, std::span<const std::uint32_t> entries) {
  const hn::CappedTag<float, 4> d;
  auto sum = hn::Zero(d);
  for (const std::uint32_t entry : entries) {
    sum = hn::Add(sum, hn::LoadU(d, &table[static_cast<std::size_t>(entry) * 4]));
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::benchmarks
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nerf::benchmarks {
HWY_EXPORT(FusedMultiplyAddsImpl);
HWY_EXPORT(SumEntriesImpl);

float FusedMultiplyAdds(std::int64_t repeats, std::int64_t& operations) {
  return HWY_DYNAMIC_DISPATCH(FusedMultiplyAddsImpl)(repeats, operations);
}
float SumEntries(std::span<const float> table, std::span<const std::uint32_t> entries) {
  return HWY_DYNAMIC_DISPATCH(SumEntriesImpl)(table, entries);
}
}  // namespace nerf::benchmarks
#endif
