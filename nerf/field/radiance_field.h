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

// What the field says of samples: density and the colour sent towards the camera.
struct FieldOutput {
  torch::Tensor sigma;     // [S]   1 / normalized scene unit, > 0
  torch::Tensor radiance;  // [S,3] in [0,1] for sRGB-encoded fields, >= 0 for linear ones
};

// The parameters: a hash encoding of position, a density network, a colour network that also sees
// the direction, unless colour is diffuse. Source: Mueller et al. 2022, section 5.4.
class RadianceField : public torch::nn::Module {
 public:
  // encoding of colour: sRGB-encoded fields end in a sigmoid, linear ones in a truncated
  // exponential.
  RadianceField(const kernels::HashGridOptions& grid, const FieldOptions& options,
                ColorEncoding encoding, std::uint64_t seed,
                ColorModel color_model = ColorModel::kViewDependent);

  // `detail` in all of these: how much of the field is active, from 0 (the coarsest levels alone,
  // no view dependence) to 1 (everything). Shape is found while only coarse positions can explain
  // the photographs; fine levels and directions could explain each of them by itself. Source: the
  // frequency regularisation of Yang et al. 2023 (FreeNeRF), on hash levels.

  // positions [S,3] in the unit cube -> [S], 1 / normalized scene unit
  //   level_weights  [S, levels] anti-aliasing weights (nerf/effects/anti_aliasing.h); undefined: 1
  torch::Tensor Density(const torch::Tensor& positions, const torch::Tensor& level_weights = {},
                        double detail = 1);
  // The same in 1 / unit of contracted space, which is what the network says: outside the unit ball
  // Density is that times 1/r^2. So a ray to infinity crosses a finite optical depth from the start
  // on, and light from its end, the background, still teaches what stands before it.
  torch::Tensor ContractedDensity(const torch::Tensor& positions,
                                  const torch::Tensor& level_weights = {}, double detail = 1);

  //   positions   [S,3] in the unit cube
  //   directions  [R,3] unit vectors, one a ray
  //   ray         [S] int64, the ray of each sample
  // Differentiable in the parameters and the positions.
  FieldOutput forward(const torch::Tensor& positions, const torch::Tensor& directions,
                      const torch::Tensor& ray, const torch::Tensor& level_weights = {},
                      double detail = 1);

  // The weight of each level of the encoding at a detail, in [0,1].
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
