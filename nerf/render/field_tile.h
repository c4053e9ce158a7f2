#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "nerf/field/radiance_field.h"
#include "nerf/render/density_tile.h"

namespace nerf {

// What the field says of the samples of a tile, and what it needs for the way back.
struct FieldTile {
  DensityTile density;          // whose seconds are those of the colours too
  std::vector<float> radiance;  // [S,3]
  TileRows color;
};

struct FieldGradients {
  DensityGradients density;
  std::vector<float> color;  // of the colour network's weights, in TileMlp's layout
};

// RadianceField for tiles of samples (see TileDensity): the same formula on the same parameters.
class TileField {
 public:
  // The field must outlive it.
  TileField(const RadianceField& field, kernels::Precision precision);

  // Copies the networks' weights, which the optimiser changes between batches.
  //   detail  see RadianceField
  void Refresh(double detail);

  const TileDensity& Density() const { return density_; }

  // Radiance of the first `samples` samples of the tile, after TileDensity::Density.
  //   ray, directions  the ray of each sample, and the direction of each ray
  void Radiance(std::int64_t samples, std::span<const std::int64_t> ray,
                std::span<const float> directions, FieldTile& tile) const;

  // The way back of Density and Radiance for the first `samples` samples; uses the tile up.
  //   dL_dsigma [S], dL_dradiance [S,3]
  void Backward(std::int64_t samples, std::span<const float> positions,
                std::span<const float> dL_dsigma, std::span<const float> dL_dradiance,
                FieldTile& tile, FieldGradients& gradients) const;

  void Clear(FieldGradients& gradients) const;
  // Adds what the threads gathered, in their order, to the gradients of the LibTorch parameters.
  void AddToParameters(std::span<const FieldGradients* const> gradients);

 private:
  const RadianceField& field_;
  TileDensity density_;
  kernels::TileMlp color_;
  int geometry_features_;
  float direction_weight_ = 1;
};

}  // namespace nerf
