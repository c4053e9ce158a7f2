#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/field/libtorch.h"
#include "nerf/image/image.h"

namespace nerf {

// Exposure compensation: a gain per photograph and channel, by which the rendered colours are
// multiplied. Without it the field explains differences in exposure by floaters.
//
// For sRGB-encoded fields the gain multiplies encoded values: the transfer curve is close to a
// power law, for which a gain g of encoded values is a gain g^2.2 of light. Source: the per-image
// affine colour of Rematas et al. 2022, "Urban Radiance Fields", without its mixing of channels.
//
// A fixed background, onto which photographs with alpha are composited, has no exposure: see
// DivideByGains. A learned background has it.
//
// Brightness could drift between the gains and the field, so the mean of the log gains is
// subtracted from each. A rendering shows the field without gains: the scene at the mean exposure.
class Exposure : public torch::nn::Module {
 public:
  // photographs  number of training photographs; all gains start at 1, which changes no bit
  Exposure(std::int64_t photographs, ColorEncoding encoding);

  // Applies the gains to rendered colours.
  //   rgb         [R,3] rendered
  //   photograph  [R] int64
  //   target      [R,3] colours of the photograph. Where a channel is clipped there and the result
  //               is brighter, the result is the target: that is no error, and has no gradient.
  //   returns     [R,3]
  // Differentiable in rgb and in the gains. Throws c10::Error on a shape mismatch.
  torch::Tensor forward(const torch::Tensor& rgb, const torch::Tensor& photograph,
                        const torch::Tensor& target);

  // Divides a background by the gains, to cancel the multiplication by them in forward.
  //   background  [R,3]    photograph  [R] int64    returns  [R,3]
  // Differentiable in the background and in the gains.
  torch::Tensor DivideByGains(const torch::Tensor& background, const torch::Tensor& photograph);

  // Sets the gains before training from measured exposures.
  //   stops  [photographs] exposure, log2 of light; the mean is subtracted
  void Initialize(std::span<const double> stops);

  // [photographs,3]
  torch::Tensor Gains() const;

  // Adds to the gradient of the gains, for engines that apply them without autograd.
  //   dL_dlog_gain  [photographs,3]
  void AddGradient(std::span<const double> dL_dlog_gain);

  // Whether photographs clip at white; linear radiance does not.
  bool Saturates() const { return encoding_ == ColorEncoding::kSrgb; }

 private:
  torch::Tensor Centred() const;

  torch::Tensor log_gain_;
  ColorEncoding encoding_;
};

}  // namespace nerf
