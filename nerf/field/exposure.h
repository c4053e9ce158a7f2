#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/field/libtorch.h"
#include "nerf/image/image.h"

namespace nerf {

// Photographs of one scene that differ in exposure and white balance: each has a gain for each
// channel, by which it multiplies what the field shows. Without it the field explains the
// differences by fog before the cameras.
//
// For sRGB-encoded fields the gain multiplies encoded values: the transfer curve is close to a
// power law, for which that is the same as a gain g^2.2 of light. Source: the per-image affine
// colour of Rematas et al. 2022, "Urban Radiance Fields", without its mixing of channels.
//
// What a ray is given as its background, where photographs are cut out by alpha, was laid under the
// photograph as it is and has no exposure: DivideByGains. A background that is learned has it.
//
// Brightness could wander from the gains into the field and back; so the mean of the log gains is
// taken from each. What is rendered is the field itself: the scene at the photographs' mean
// exposure.
class Exposure : public torch::nn::Module {
 public:
  // photographs  to train on; all start with the gain 1, which changes no bit
  Exposure(std::int64_t photographs, ColorEncoding encoding);

  // What the photographs would show.
  //   rgb         [R,3] of the field
  //   photograph  [R] int64
  //   target      [R,3] what the photographs do show: of a pixel that is white to the end of its
  //               scale more is not known than that, and a brighter colour is no error
  //   returns     [R,3]
  // Differentiable in rgb and in the gains.
  torch::Tensor forward(const torch::Tensor& rgb, const torch::Tensor& photograph,
                        const torch::Tensor& target);

  // A background that the gains will multiply back to what it is.
  //   background  [R,3]    photograph  [R] int64    returns  [R,3]
  // Differentiable as forward is.
  torch::Tensor DivideByGains(const torch::Tensor& background, const torch::Tensor& photograph);

  // Sets the gains before training, as EXIF tells of them.
  //   stops  [photographs] exposure, log2 of light; their mean is taken from each
  void Start(std::span<const double> stops);

  // [photographs,3]
  torch::Tensor Gains() const;

  // The way back of the gains, for those who multiply by themselves: adds to the parameter's
  // gradient.
  //   dL_dlog_gain  [photographs,3]
  void AddGradient(std::span<const double> dL_dlog_gain);

  // Pixels that are white to the end of their scale, where there is one.
  bool Saturates() const { return encoding_ == ColorEncoding::kSrgb; }

 private:
  torch::Tensor Centred() const;

  torch::Tensor log_gain_;
  ColorEncoding encoding_;
};

}  // namespace nerf
