#include "nerf/render/field_tile.h"

#include <algorithm>
#include <array>

#include "nerf/base/stopwatch.h"
#include "nerf/effects/view_dependence.h"
#include "nerf/field/activations.h"
#include "nerf/field/direction_encoding.h"
#include "nerf/kernels/activations.h"
#include "nerf/kernels/matrix_product.h"

namespace nerf {

using kernels::PaddedWidth;

TileField::TileField(const RadianceField& field, kernels::Precision precision)
    : field_(field),
      density_(field_.Hash(), field_.DensityNetwork(), precision),
      color_(field_.ColorNetwork().Widths(), precision),
      geometry_features_(density_.Outputs() - 1) {}

void TileField::Refresh(double detail) {
  density_.Refresh(field_.DetailWeights(detail));
  LoadWeights(field_.ColorNetwork(), color_);
  direction_weight_ = static_cast<float>(detail);
}

void TileField::Radiance(std::int64_t samples, std::span<const std::int64_t> ray,
                         std::span<const float> directions, FieldTile& tile) const {
  LapTimer timer;
  tile.color.Resize(color_, samples);
  const int in_row = PaddedWidth(color_.Width(0));
  std::array<float, kDirectionFeatures> view{};
  // 0 where colour is diffuse.
  const int view_features = color_.Width(0) - geometry_features_;
  for (std::int64_t i = 0; i < samples; ++i) {
    if (view_features > 0 && (i == 0 || ray[i] != ray[i - 1])) {
      kernels::EncodeDirection(directions.subspan(3 * ray[i]).first<3>(), view);
      for (float& feature : view) feature *= direction_weight_;
    }
    float* const in = tile.color.rows[0] + i * in_row;
    std::copy_n(density_.Output(tile.density, i) + 1, geometry_features_, in);
    std::copy_n(view.begin(), view_features, in + geometry_features_);
    std::fill(in + color_.Width(0), in + in_row, 0.0f);
  }
  color_.Forward(samples, tile.color.rows);
  const float* const out = tile.color.rows[color_.Layers()];
  tile.radiance.resize(3 * samples);
  for (std::int64_t i = 0; i < samples; ++i) {
    std::copy_n(out + i * PaddedWidth(3), 3, &tile.radiance[3 * i]);
  }
  if (field_.Encoding() == ColorEncoding::kSrgb) {
    kernels::Sigmoid(tile.radiance);
  } else {
    kernels::TruncatedExp(tile.radiance, 0.0f, static_cast<float>(kExpLimit));
  }
  timer.Lap(tile.density.seconds.networks);
}

void TileField::Backward(std::int64_t samples, std::span<const float> positions,
                         std::span<const float> dL_dsigma, std::span<const float> dL_dradiance,
                         FieldTile& tile, FieldGradients& gradients) const {
  LapTimer timer;
  const bool sigmoid = field_.Encoding() == ColorEncoding::kSrgb;
  float* const dL_dout = tile.color.rows[color_.Layers()];
  for (std::int64_t i = 0; i < samples; ++i) {
    for (int c = 0; c < 3; ++c) {
      const float y = tile.radiance[3 * i + c];
      dL_dout[i * PaddedWidth(3) + c] = dL_dradiance[3 * i + c] * (sigmoid ? y * (1.0f - y) : y);
    }
  }
  color_.Backward(samples, tile.color.rows, gradients.color);
  const int in_row = PaddedWidth(color_.Width(0));
  for (std::int64_t i = 0; i < samples; ++i) {
    std::copy_n(tile.color.rows[0] + i * in_row, geometry_features_,
                density_.Output(tile.density, i) + 1);
  }
  timer.Lap(tile.density.seconds.networks);
  density_.Backward(samples, positions, dL_dsigma, tile.density, gradients.density);
}

void TileField::Clear(FieldGradients& gradients) const {
  density_.Clear(gradients.density);
  gradients.color.assign(color_.GradientSize(), 0.0f);
}

void TileField::AddToParameters(std::span<const FieldGradients* const> gradients) {
  std::vector<const DensityGradients*> of_density;
  for (const FieldGradients* part : gradients) {
    AddWeightGradients(part->color, color_, field_.ColorNetwork());
    of_density.push_back(&part->density);
  }
  density_.AddToParameters(of_density);
}

}  // namespace nerf
