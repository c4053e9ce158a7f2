#include "nerf/kernels/adam.h"

#include <algorithm>
#include <cmath>

#include "nerf/kernels/flush_denormals.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nerf/kernels/adam.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The coefficients, broadcast to all lanes.
template <class D>
struct Coefficients {
  using V = hn::Vec<D>;
  Coefficients(D d, const AdamCoefficients& adam)
      : beta1(hn::Set(d, adam.beta1)),
        beta2(hn::Set(d, adam.beta2)),
        rest1(hn::Set(d, 1 - adam.beta1)),
        rest2(hn::Set(d, 1 - adam.beta2)),
        epsilon(hn::Set(d, adam.epsilon)),
        weight_decay(hn::Set(d, adam.weight_decay)) {}
  V beta1, beta2, rest1, rest2, epsilon, weight_decay;
};

// The step of one vector. Returns 0 in lanes where gradient and new parameter are finite and NaN
// elsewhere: x * 0 is 0 for every finite x, so that one sum checks them all.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Step(D d, const Coefficients<D>& c, V step_size, V root_second, float* p, float* g,
                  float* m, float* v) {
  const V zero = hn::Zero(d), old = hn::LoadU(d, p), gradient = hn::LoadU(d, g);
  const V total = hn::MulAdd(c.weight_decay, old, gradient);
  const V first = hn::MulAdd(c.beta1, hn::LoadU(d, m), hn::Mul(c.rest1, total));
  const V second = hn::MulAdd(c.beta2, hn::LoadU(d, v), hn::Mul(c.rest2, hn::Mul(total, total)));
  const V scale = hn::MulAdd(hn::Sqrt(second), root_second, c.epsilon);
  const V now = hn::Sub(old, hn::Div(hn::Mul(step_size, first), scale));
  hn::StoreU(first, d, m);
  hn::StoreU(second, d, v);
  hn::StoreU(now, d, p);
  hn::StoreU(zero, d, g);
  return hn::MulAdd(gradient, zero, hn::Mul(now, zero));
}

bool DenseImpl(const AdamCoefficients& adam, const AdamBiasCorrection& correction, float* p,
               float* g, float* m, float* v, std::size_t count) {
  const auto run = [&](auto d, std::size_t begin, std::size_t end) HWY_ATTR {
    const Coefficients<decltype(d)> c(d, adam);
    const auto step_size = hn::Set(d, adam.learning_rate * correction.first);
    const auto root_second = hn::Set(d, correction.root_second);
    auto check = hn::Zero(d);
    for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
      check = hn::Add(check, Step(d, c, step_size, root_second, p + i, g + i, m + i, v + i));
    }
    return hn::GetLane(hn::SumOfLanes(d, check)) == 0.0f;
  };
  const hn::ScalableTag<float> whole;
  const std::size_t in_vectors = count - count % hn::Lanes(whole);
  const bool finite = run(whole, 0, in_vectors);
  return run(hn::CappedTag<float, 1>(), in_vectors, count) && finite;
}

// Processes entries in vectors of at most 4 lanes, the shortest vector length.
template <int kFeatures>
bool SparseStep(const AdamCoefficients& adam, std::span<const AdamBiasCorrection> corrections,
                float* p, float* g, float* m, float* v, std::span<std::int32_t> steps) {
  constexpr int kMostLanes = HWY_TARGET == HWY_SCALAR ? 1 : 4;
  constexpr int kLanes = kFeatures < kMostLanes ? kFeatures : kMostLanes;
  using D = hn::FixedTag<float, kLanes>;
  const D d;
  const Coefficients<D> c(d, adam);
  const auto settled = static_cast<std::int32_t>(corrections.size()) - 1;
  auto check = hn::Zero(d);
  for (std::size_t entry = 0; entry < steps.size();
       ++entry, p += kFeatures, g += kFeatures, m += kFeatures, v += kFeatures) {
    bool untouched = true;
    for (int f = 0; f < kFeatures; f += kLanes) {
      untouched = untouched && hn::AllTrue(d, hn::Eq(hn::LoadU(d, g + f), hn::Zero(d)));
    }
    if (untouched) continue;
    // Not counted beyond the number of steps from which the correction is 1.
    steps[entry] = std::min(steps[entry] + 1, settled);
    const AdamBiasCorrection correction = corrections[steps[entry]];
    const auto step_size = hn::Set(d, adam.learning_rate * correction.first);
    const auto root_second = hn::Set(d, correction.root_second);
    for (int f = 0; f < kFeatures; f += kLanes) {
      check = hn::Add(check, Step(d, c, step_size, root_second, p + f, g + f, m + f, v + f));
    }
  }
  return hn::GetLane(hn::SumOfLanes(d, check)) == 0.0f;
}

bool SparseImpl(const AdamCoefficients& adam, int features,
                std::span<const AdamBiasCorrection> corrections, float* p, float* g, float* m,
                float* v, std::span<std::int32_t> steps) {
  const auto step = features == 1   ? SparseStep<1>
                    : features == 2 ? SparseStep<2>
                    : features == 4 ? SparseStep<4>
                                    : SparseStep<8>;
  return step(adam, corrections, p, g, m, v, steps);
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nerf::kernels {
HWY_EXPORT(DenseImpl);
HWY_EXPORT(SparseImpl);

AdamBiasCorrection BiasCorrection(const AdamCoefficients& adam, std::int64_t steps) {
  const auto rest = [&](float beta) {
    return 1.0 - std::pow(static_cast<double>(beta), static_cast<double>(steps));
  };
  return {static_cast<float>(1.0 / rest(adam.beta1)),
          static_cast<float>(1.0 / std::sqrt(rest(adam.beta2)))};
}

std::vector<AdamBiasCorrection> BiasCorrections(const AdamCoefficients& adam) {
  std::vector<AdamBiasCorrection> corrections(1);
  do {
    corrections.push_back(BiasCorrection(adam, static_cast<std::int64_t>(corrections.size())));
  } while (corrections.back().first > 1 || corrections.back().root_second > 1);
  return corrections;
}

bool AdamStep(const AdamCoefficients& adam, const AdamBiasCorrection& correction,
              std::span<float> parameter, std::span<float> gradient, std::span<float> first_moment,
              std::span<float> second_moment) {
  const FlushDenormals flush;
  return HWY_DYNAMIC_DISPATCH(DenseImpl)(adam, correction, parameter.data(), gradient.data(),
                                         first_moment.data(), second_moment.data(),
                                         parameter.size());
}

bool SparseAdamStep(const AdamCoefficients& adam, int features,
                    std::span<const AdamBiasCorrection> corrections, std::span<float> parameter,
                    std::span<float> gradient, std::span<float> first_moment,
                    std::span<float> second_moment, std::span<std::int32_t> steps) {
  const FlushDenormals flush;
  return HWY_DYNAMIC_DISPATCH(SparseImpl)(adam, features, corrections, parameter.data(),
                                          gradient.data(), first_moment.data(),
                                          second_moment.data(), steps);
}

}  // namespace nerf::kernels
#endif
