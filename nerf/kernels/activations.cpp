#include "nerf/kernels/activations.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nerf/kernels/activations.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;

// exp of x clamped to [-limit, limit]. Min, Max and Highway's Exp would turn NaN into a number, so
// it is selected explicitly.
HWY_INLINE V BoundedExp(V x, V limit) {
  const D d;
  const V low = hn::IfThenElse(hn::Lt(x, hn::Neg(limit)), hn::Neg(limit), x);
  const V clamped = hn::IfThenElse(hn::Gt(low, limit), limit, low);
  return hn::IfThenElse(hn::IsNaN(x), x, hn::Exp(d, clamped));
}

// Applies f to each vector of x; the last one is padded with zeros.
template <class F>
HWY_INLINE void Transform(float* x, std::size_t count, F&& f) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) hn::StoreU(f(hn::LoadU(d, x + i)), d, x + i);
  if (i == count) return;
  HWY_ALIGN float rest[16] = {};
  std::copy(x + i, x + count, rest);
  hn::Store(f(hn::Load(d, rest)), d, rest);
  std::copy(rest, rest + (count - i), x + i);
}

void TruncatedExpImpl(float* x, std::size_t count, float bias, float limit) {
  const D d;
  const V b = hn::Set(d, bias), l = hn::Set(d, limit);
  Transform(x, count, [&](V v) HWY_ATTR { return BoundedExp(hn::Add(v, b), l); });
}

void SigmoidImpl(float* x, std::size_t count) {
  const D d;
  const V one = hn::Set(d, 1.0f), limit = hn::Set(d, 80.0f);
  Transform(x, count, [&](V v) HWY_ATTR {
    return hn::Div(one, hn::Add(one, BoundedExp(hn::Neg(v), limit)));
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nerf::kernels {
HWY_EXPORT(TruncatedExpImpl);
HWY_EXPORT(SigmoidImpl);

void TruncatedExp(std::span<float> x, float bias, float limit) {
  HWY_DYNAMIC_DISPATCH(TruncatedExpImpl)(x.data(), x.size(), bias, limit);
}
void Sigmoid(std::span<float> x) { HWY_DYNAMIC_DISPATCH(SigmoidImpl)(x.data(), x.size()); }
}  // namespace nerf::kernels
#endif
