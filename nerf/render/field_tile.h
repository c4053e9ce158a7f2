#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "nerf/field/radiance_field.h"
#include "nerf/render/density_tile.h"

namespace nerf {

// Density and radiance of the samples of a tile, and the intermediate results for the backward
// pass.
struct FieldTile {
  DensityTile density;          // its seconds include the colour network
  std::vector<float> radiance;  // [S,3]
  TileRows color;
};

struct FieldGradients {
  DensityGradients density;
  std::vector<float> color;  // of the weights of the colour network, in TileMlp's layout
};

// RadianceField for tiles of samples: the same formula on the same parameters, see TileDensity.
class TileField {
 public:
  // The field must outlive it.
  TileField(const RadianceField& field, kernels::Precision precision);

  // Copies the networks' weights, which the optimiser changes between batches.
  //   detail  see RadianceField
  void Refresh(double detail);

  const TileDensity& Density() const { return density_; }

  // The radiance of the first `samples` samples of the tile, after TileDensity::Density.
  //   ray         [S] the ray of each sample
  //   directions  [R,3] unit vectors
  void Radiance(std::int64_t samples, std::span<const std::int64_t> ray,
                std::span<const float> directions, FieldTile& tile) const;

  // The backward pass of Density and Radiance for the first `samples` samples. Overwrites the tile.
  //   dL_dsigma [S], dL_dradiance [S,3]
  void Backward(std::int64_t samples, std::span<const float> positions,
                std::span<const float> dL_dsigma, std::span<const float> dL_dradiance,
                FieldTile& tile, FieldGradients& gradients) const;

  void Clear(FieldGradients& gradients) const;
  // Adds the gradients of all threads, in their order, to those of the LibTorch parameters.
  void AddToParameters(std::span<const FieldGradients* const> gradients);

 private:
  const RadianceField& field_;
  TileDensity density_;
  kernels::TileMlp color_;
  int geometry_features_;
  float direction_weight_ = 1;
};

}  // namespace nerf
