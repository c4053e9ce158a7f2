#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "nerf/field/hash_encoding.h"
#include "nerf/field/mlp.h"
#include "nerf/kernels/mlp.h"
#include "nerf/render/stage_seconds.h"

namespace nerf {

// The activations of each layer of a network, one row per sample of a tile. Memory is reused from
// tile to tile.
struct TileRows {
  std::vector<std::vector<float>> storage;  // per layer
  std::vector<float*> rows;                 // pointers to the storage

  void Resize(const kernels::TileMlp& mlp, std::int64_t samples);
};

// The densities of a tile of samples, and the intermediate results for the backward pass.
struct DensityTile {
  std::vector<float> footprint;      // [S] input, for anti-aliasing; or empty
  std::vector<float> level_weights;  // [S, levels] anti-aliasing weights; or empty
  std::vector<float> sigma;          // [S]
  TileRows activations;
  StageSeconds seconds;  // of encoding and networks, accumulated
};

// The gradients that one thread accumulates over its tiles; added to the LibTorch tensors once per
// batch.
struct DensityGradients {
  std::vector<float> network;  // of the weights, in TileMlp's layout
  // The gradients of the encodings, sample by sample; scattered into the table level by level.
  std::vector<float> position;     // [S,3]
  std::vector<float> dL_dencoded;  // [S, row]
};

// Copies the weights of a LibTorch network.
void LoadWeights(const Mlp& from, kernels::TileMlp& to);
// Adds gradients in TileMlp's layout to the gradients of a LibTorch network.
void AddWeightGradients(std::span<const float> sums, const kernels::TileMlp& layout,
                        const Mlp& network);

// A hash encoding and its network, whose first output is the log density, for tiles of samples that
// fit in a core's cache: the same formula on the same parameters as the LibTorch modules, in float,
// without LibTorch operations. Only the scattering of gradients into the table works on whole
// batches, with one thread per level.
class TileDensity {
 public:
  // The modules must outlive it.
  TileDensity(const HashEncoding& hash, const Mlp& network,
              kernels::Precision precision = kernels::Precision::kFloat);

  // Copies the network's weights, which the optimiser changes between batches. The hash table is
  // not copied.
  void Refresh(std::vector<float> level_weights);

  // positions [S,3] in the unit cube -> tile.sigma in 1 / unit of contracted space. tile.footprint
  // may be set.
  void ContractedDensity(std::span<const float> positions, DensityTile& tile) const;
  // The same in 1 / normalized scene unit.
  void Density(std::span<const float> positions, DensityTile& tile) const;

  // The network's outputs for sample i; sigma is computed from the first.
  float* Output(DensityTile& tile, std::int64_t i) const;
  int Outputs() const { return network_.Width(network_.Layers()); }

  // Keeps only the tile's samples with the given indices, which must increase.
  void Keep(std::span<const std::int64_t> kept, DensityTile& tile) const;

  // The backward pass of the first `samples` samples. Output must contain dL/doutput, except for
  // the first output, whose gradient is computed from dL_dsigma. Overwrites the tile.
  void Backward(std::int64_t samples, std::span<const float> positions,
                std::span<const float> dL_dsigma, DensityTile& tile,
                DensityGradients& gradients) const;

  void Clear(DensityGradients& gradients) const;
  // Adds the gradients of the samples' positions through the encoding.
  //   dL_dposition  [S,3], accumulated into
  void AddToPositions(const DensityGradients& gradients, std::span<float> dL_dposition) const;
  // Adds the gradients of all threads, in their order, to those of the LibTorch parameters.
  void AddToParameters(std::span<const DensityGradients* const> gradients);

 private:
  int Row() const;  // stride between the encodings of two samples, floats
  void ApplyAntiAliasing(std::int64_t samples, DensityTile& tile) const;

  const HashEncoding& hash_;
  const Mlp& module_;
  kernels::TileMlp network_;
  std::vector<float> level_weights_;
};

}  // namespace nerf
