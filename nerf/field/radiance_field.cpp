#include "nerf/field/radiance_field.h"

#include <algorithm>

#include "nerf/base/random.h"
#include "nerf/field/activations.h"
#include "nerf/field/density.h"
#include "nerf/field/direction_encoding.h"

namespace nerf {
namespace {

// Levels that are active at detail 0.
constexpr double kCoarsestLevels = 2.0;

std::vector<std::int64_t> ColorWidths(const FieldOptions& options, ColorModel color_model) {
  std::vector<std::int64_t> widths = {options.geometry_features};
  if (color_model == ColorModel::kViewDependent) widths[0] += kDirectionFeatures;
  widths.insert(widths.end(), options.color_layers, options.hidden_width);
  widths.push_back(3);
  return widths;
}

}  // namespace

RadianceField::RadianceField(const kernels::HashGridOptions& grid, const FieldOptions& options,
                             ColorEncoding encoding, std::uint64_t seed, ColorModel color_model)
    : encoding_(encoding),
      color_model_(color_model),
      geometry_features_(options.geometry_features) {
  hash_encoding_ =
      register_module("hash_encoding", std::make_shared<HashEncoding>(grid, Mix64(seed + 0)));
  density_network_ = register_module(
      "density_network",
      std::make_shared<Mlp>(
          std::vector<std::int64_t>{hash_encoding_->Layout().OutputSize(), options.hidden_width,
                                    1 + options.geometry_features},
          Mix64(seed + 1)));
  color_network_ = register_module(
      "color_network", std::make_shared<Mlp>(ColorWidths(options, color_model), Mix64(seed + 2)));
}

std::vector<float> RadianceField::DetailWeights(double detail) const {
  const std::size_t levels = hash_encoding_->Layout().levels.size();
  std::vector<float> weights(levels, 1.0f);
  if (detail >= 1) return weights;
  const double active = kCoarsestLevels + detail * (static_cast<double>(levels) - kCoarsestLevels);
  for (std::size_t l = 0; l < levels; ++l) {
    weights[l] = static_cast<float>(std::clamp(active - static_cast<double>(l), 0.0, 1.0));
  }
  return weights;
}

// The encoded positions, with the levels beyond the detail faded out.
torch::Tensor RadianceField::Encode(const torch::Tensor& positions,
                                    const torch::Tensor& level_weights, double detail) {
  torch::Tensor encoded = hash_encoding_->forward(positions);
  if (level_weights.defined()) {
    encoded = encoded * level_weights.repeat_interleave(hash_encoding_->Layout().features, 1);
  }
  if (detail >= 1) return encoded;
  const torch::Tensor weights = torch::tensor(DetailWeights(detail), encoded.options());
  return encoded * weights.repeat_interleave(hash_encoding_->Layout().features);
}

torch::Tensor RadianceField::ContractedDensity(const torch::Tensor& positions,
                                               const torch::Tensor& level_weights, double detail) {
  const torch::Tensor out = density_network_->forward(Encode(positions, level_weights, detail));
  return ActivateDensity(out.select(1, 0));
}

torch::Tensor RadianceField::Density(const torch::Tensor& positions,
                                     const torch::Tensor& level_weights, double detail) {
  return ContractedDensity(positions, level_weights, detail) * RadialShrinkage(positions);
}

FieldOutput RadianceField::forward(const torch::Tensor& positions, const torch::Tensor& directions,
                                   const torch::Tensor& ray, const torch::Tensor& level_weights,
                                   double detail) {
  const torch::Tensor out = density_network_->forward(Encode(positions, level_weights, detail));
  const torch::Tensor geometry = out.slice(1, 1);
  torch::Tensor color_input = geometry;
  if (color_model_ == ColorModel::kViewDependent) {
    // Encoded once per ray, then gathered for its samples.
    const torch::Tensor view = (detail * EncodeDirections(directions)).index_select(0, ray);
    color_input = torch::cat({geometry, view}, 1);
  }
  const torch::Tensor color = color_network_->forward(color_input);
  return {ActivateDensity(out.select(1, 0)) * RadialShrinkage(positions),
          encoding_ == ColorEncoding::kSrgb ? torch::sigmoid(color) : TruncatedExp(color)};
}

torch::Dtype RadianceField::Dtype() const { return parameters().front().scalar_type(); }

}  // namespace nerf
