#pragma once

#include <memory>
#include <vector>

#include "nerf/config/field_options.h"
#include "nerf/effects/view_dependence.h"
#include "nerf/field/hash_encoding.h"
#include "nerf/field/libtorch.h"
#include "nerf/field/mlp.h"
#include "nerf/image/image.h"

namespace nerf {

// Density and radiance of samples.
struct FieldOutput {
  torch::Tensor sigma;     // [S]   1 / normalized scene unit, > 0
  torch::Tensor radiance;  // [S,3] in [0,1] for sRGB-encoded fields, >= 0 for linear ones
};

// The radiance field: a hash encoding of position, a density network, and a colour network that
// also takes the direction unless colour is diffuse. Source: Mueller et al. 2022, section 5.4.
//
// `detail` is the coarse-to-fine schedule: how much of the field is active, from 0 (the coarsest
// levels only, no view dependence) to 1 (everything). Geometry is found while only coarse levels
// are active; fine levels and directions could overfit to each photograph. Source: the frequency
// regularisation of Yang et al. 2023, "FreeNeRF", applied to hash levels.
class RadianceField : public torch::nn::Module {
 public:
  //   encoding  of colour: the activation is a sigmoid for sRGB-encoded fields, a truncated
  //             exponential for linear ones
  RadianceField(const kernels::HashGridOptions& grid, const FieldOptions& options,
                ColorEncoding encoding, std::uint64_t seed,
                ColorModel color_model = ColorModel::kViewDependent);

  // positions [S,3] in the unit cube -> [S], 1 / normalized scene unit
  //   level_weights  [S, levels] anti-aliasing weights (nerf/effects/anti_aliasing.h); undefined: 1
  // Differentiable in the parameters and the positions.
  torch::Tensor Density(const torch::Tensor& positions, const torch::Tensor& level_weights = {},
                        double detail = 1);
  // The same in 1 / unit of contracted space, before RadialShrinkage: outside the unit ball Density
  // is this divided by r^2. So the optical depth of a ray to infinity is finite from the start, and
  // gradients from the background reach the samples in front of it.
  torch::Tensor ContractedDensity(const torch::Tensor& positions,
                                  const torch::Tensor& level_weights = {}, double detail = 1);

  // Density and radiance of samples.
  //   positions   [S,3] in the unit cube
  //   directions  [R,3] unit vectors, one per ray
  //   ray         [S] int64, the ray of each sample
  // Differentiable in the parameters and the positions.
  FieldOutput forward(const torch::Tensor& positions, const torch::Tensor& directions,
                      const torch::Tensor& ray, const torch::Tensor& level_weights = {},
                      double detail = 1);

  // [levels] The weight of each level of the encoding at a detail, in [0,1].
  std::vector<float> DetailWeights(double detail) const;

  torch::Dtype Dtype() const;
  ColorEncoding Encoding() const { return encoding_; }
  ColorModel GetColorModel() const { return color_model_; }
  const HashEncoding& Hash() const { return *hash_encoding_; }
  const Mlp& DensityNetwork() const { return *density_network_; }
  const Mlp& ColorNetwork() const { return *color_network_; }

 private:
  torch::Tensor Encode(const torch::Tensor& positions, const torch::Tensor& level_weights,
                       double detail);

  ColorEncoding encoding_;
  ColorModel color_model_;
  int geometry_features_;
  std::shared_ptr<HashEncoding> hash_encoding_;
  std::shared_ptr<Mlp> density_network_;  // encoded position -> log density, geometry features
  std::shared_ptr<Mlp> color_network_;    // geometry features, direction features -> colour
};

}  // namespace nerf
