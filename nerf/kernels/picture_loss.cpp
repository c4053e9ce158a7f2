#include "nerf/kernels/picture_loss.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nerf/kernels/picture_loss.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;

// exp(-k^2 / (2 1.5^2)), normalized to a sum of 1 over the window.
constexpr float kTap[kWindowRadius + 1] = {0.26601172f, 0.21300553f, 0.10936069f,
                                           0.03600077f, 0.00759876f, 0.00102838f};
constexpr float kC1 = 1e-4f, kC2 = 9e-4f;  // of SSIM, for values up to 1
constexpr std::size_t kMargin = 16;        // zeros on both sides of a row, at least the radius

HWY_INLINE V Constant(float value) { return hn::Set(D(), value); }

// A copy of a row between margins of zeros; beyond the row there are zeros for a whole vector.
class PaddedRow {
 public:
  explicit PaddedRow(std::size_t width) : values_(width + 3 * kMargin, 0.0f) {}
  float* Data() { return values_.data() + kMargin; }

 private:
  std::vector<float> values_;
};

HWY_INLINE V BlurredAt(const float* padded, std::size_t x) {
  const D d;
  V sum = Constant(kTap[0]) * hn::LoadU(d, padded + x);
  for (std::size_t k = 1; k <= kWindowRadius; ++k) {
    sum = hn::MulAdd(Constant(kTap[k]), hn::LoadU(d, padded + x - k) + hn::LoadU(d, padded + x + k),
                     sum);
  }
  return sum;
}

HWY_INLINE V BlurredAcross(const RowsAround& rows, std::size_t x) {
  const D d;
  V sum = Constant(kTap[0]) * hn::LoadU(d, rows.rows[kWindowRadius] + x);
  for (int k = 1; k <= kWindowRadius; ++k) {
    const float* const above = rows.rows[kWindowRadius - k];
    const float* const below = rows.rows[kWindowRadius + k];
    if (above != nullptr) sum = hn::MulAdd(Constant(kTap[k]), hn::LoadU(d, above + x), sum);
    if (below != nullptr) sum = hn::MulAdd(Constant(kTap[k]), hn::LoadU(d, below + x), sum);
  }
  return sum;
}

void BlurPadded(PaddedRow& row, std::span<float> out) {
  const D d;
  for (std::size_t x = 0; x < out.size(); x += hn::Lanes(d)) {
    hn::StoreU(BlurredAt(row.Data(), x), d, out.data() + x);
  }
}

void ProductsImpl(std::span<const float> x, std::span<const float> y, const ProductRows& out) {
  PaddedRow row(x.size());
  const auto blur = [&](int product, const auto& value) HWY_ATTR {
    for (std::size_t i = 0; i < x.size(); ++i) row.Data()[i] = value(i);
    BlurPadded(row, out[product]);
  };
  blur(0, [&](std::size_t i) { return x[i]; });
  blur(1, [&](std::size_t i) { return x[i] * x[i]; });
  blur(2, [&](std::size_t i) { return x[i] * y[i]; });
  blur(3, [&](std::size_t i) { return y[i]; });
  blur(4, [&](std::size_t i) { return y[i] * y[i]; });
}

double DerivativesImpl(const std::array<RowsAround, kProducts>& products,
                       std::span<const float> weight, const DerivativeRows& out) {
  const D d;
  const std::size_t width = weight.size();
  PaddedRow by_mean(width), by_square(width), by_product(width);
  V total = hn::Zero(d);
  const V one = Constant(1), two = Constant(2);
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const V mean_x = BlurredAcross(products[0], i), mean_y = BlurredAcross(products[3], i);
    const V variance_x = BlurredAcross(products[1], i) - mean_x * mean_x;
    const V variance_y = BlurredAcross(products[4], i) - mean_y * mean_y;
    const V covariance = BlurredAcross(products[2], i) - mean_x * mean_y;
    const V a = two * mean_x * mean_y + Constant(kC1), b = two * covariance + Constant(kC2);
    const V c = mean_x * mean_x + mean_y * mean_y + Constant(kC1);
    const V e = variance_x + variance_y + Constant(kC2);
    const V inverse = one / (c * e);
    const V similarity = a * b * inverse;
    const V w = hn::LoadU(d, weight.data() + i);
    const V square = hn::Neg(similarity / e), product = two * a * inverse;
    const V mean =
        two * (mean_y * b * inverse - mean_x * similarity / c - mean_x * square) - mean_y * product;
    total = hn::MulAdd(w, similarity, total);
    hn::StoreU(w * mean, d, by_mean.Data() + i);
    hn::StoreU(w * square, d, by_square.Data() + i);
    hn::StoreU(w * product, d, by_product.Data() + i);
  }
  BlurPadded(by_mean, out[0]);
  BlurPadded(by_square, out[1]);
  BlurPadded(by_product, out[2]);
  return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, total)));
}

double GradientImpl(const std::array<RowsAround, 3>& derivatives, std::span<const float> x,
                    std::span<const float> y, std::span<const float> weight, float structural,
                    std::span<float> gradient) {
  const D d;
  const V s = Constant(structural), rest = Constant(1 - structural), two = Constant(2);
  V total = hn::Zero(d);
  for (std::size_t i = 0; i < weight.size(); i += hn::Lanes(d)) {
    const V value = hn::LoadU(d, x.data() + i), truth = hn::LoadU(d, y.data() + i);
    const V w = rest * hn::LoadU(d, weight.data() + i), difference = value - truth;
    const V root =
        hn::Sqrt(hn::MulAdd(difference, difference, Constant(kCharbonnier * kCharbonnier)));
    total = hn::MulAdd(w, root, total);
    const V similar = BlurredAcross(derivatives[0], i) +
                      two * value * BlurredAcross(derivatives[1], i) +
                      truth * BlurredAcross(derivatives[2], i);
    const V by_x = w * difference / root - s * similar;
    hn::StoreU(hn::IfThenElseZero(hn::Gt(hn::LoadU(d, weight.data() + i), hn::Zero(d)), by_x), d,
               gradient.data() + i);
  }
  return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, total)));
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nerf::kernels {

HWY_EXPORT(ProductsImpl);
HWY_EXPORT(DerivativesImpl);
HWY_EXPORT(GradientImpl);

void BlurProducts(std::span<const float> x, std::span<const float> y, const ProductRows& out) {
  HWY_DYNAMIC_DISPATCH(ProductsImpl)(x, y, out);
}

double SimilarityDerivatives(const std::array<RowsAround, kProducts>& products,
                             std::span<const float> weight, const DerivativeRows& out) {
  return HWY_DYNAMIC_DISPATCH(DerivativesImpl)(products, weight, out);
}

double PictureLossGradient(const std::array<RowsAround, 3>& derivatives, std::span<const float> x,
                           std::span<const float> y, std::span<const float> weight,
                           float structural, std::span<float> gradient) {
  return HWY_DYNAMIC_DISPATCH(GradientImpl)(derivatives, x, y, weight, structural, gradient);
}

}  // namespace nerf::kernels
#endif
