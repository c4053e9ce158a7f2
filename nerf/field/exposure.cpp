#include "nerf/field/exposure.h"

#include <cmath>
#include <vector>

#include "nerf/field/tensor_span.h"

namespace nerf {
namespace {

// The exponent of the power law that approximates the sRGB curve.
constexpr double kGamma = 2.2;

}  // namespace

Exposure::Exposure(std::int64_t photographs, ColorEncoding encoding) : encoding_(encoding) {
  TORCH_CHECK(photographs > 0, "Exposure: no photographs");
  log_gain_ = register_parameter("log_gain", torch::zeros({photographs, 3}));
}

torch::Tensor Exposure::Centred() const { return log_gain_ - log_gain_.mean(0, true); }

torch::Tensor Exposure::Gains() const { return Centred().exp(); }

torch::Tensor Exposure::forward(const torch::Tensor& rgb, const torch::Tensor& photograph,
                                const torch::Tensor& target) {
  TORCH_CHECK(rgb.sizes() == target.sizes() && rgb.size(0) == photograph.size(0), "Exposure: rgb ",
              rgb.sizes(), ", target ", target.sizes(), " and photograph ", photograph.sizes(),
              " do not match");
  const torch::Tensor shown = rgb * Gains().to(rgb.scalar_type()).index_select(0, photograph);
  if (!Saturates()) return shown;
  return torch::where(torch::logical_and(target >= 1, shown > 1), target, shown);
}

torch::Tensor Exposure::DivideByGains(const torch::Tensor& background,
                                      const torch::Tensor& photograph) {
  return background / Gains().to(background.scalar_type()).index_select(0, photograph);
}

void Exposure::Initialize(std::span<const double> stops) {
  TORCH_CHECK(static_cast<std::int64_t>(stops.size()) == log_gain_.size(0),
              "Exposure: ", stops.size(), " exposures for ", log_gain_.size(0), " photographs");
  const torch::NoGradGuard no_grad;
  const double scale = std::log(2.0) / (encoding_ == ColorEncoding::kSrgb ? kGamma : 1.0);
  for (std::size_t i = 0; i < stops.size(); ++i) {
    log_gain_[static_cast<std::int64_t>(i)].fill_(scale * stops[i]);
  }
  log_gain_.copy_(Centred());
}

void Exposure::AddGradient(std::span<const double> dL_dlog_gain) {
  const torch::NoGradGuard no_grad;
  const std::vector<double> values(dL_dlog_gain.begin(), dL_dlog_gain.end());
  const torch::Tensor gradient = TensorOf(values, log_gain_.sizes(), torch::kDouble);
  const torch::Tensor centred = (gradient - gradient.mean(0, true)).to(log_gain_.scalar_type());
  torch::Tensor& into = log_gain_.mutable_grad();
  into = into.defined() ? into + centred : centred;
}

}  // namespace nerf
