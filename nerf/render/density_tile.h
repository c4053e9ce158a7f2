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

// Rows of activations of the samples of a tile, one a sample, kept from tile to tile.
struct TileRows {
  std::vector<std::vector<float>> storage;  // a layer of a network each
  std::vector<float*> rows;                 // the same as pointers

  void Resize(const kernels::TileMlp& mlp, std::int64_t samples);
};

// Densities of the samples of a tile, and what the way back needs.
struct DensityTile {
  std::vector<float> footprint;      // [S] to be set before, where pixels see patches; or empty
  std::vector<float> level_weights;  // [S, levels] anti-aliasing weights; or empty
  std::vector<float> sigma;          // [S]
  TileRows activations;
  StageSeconds seconds;  // so far, for encoding and networks
};

// Sums of gradients of one thread; LibTorch's tensors get them once a batch.
struct DensityGradients {
  std::vector<float> network;  // of its weights, in TileMlp's layout
  // What reached the encoding, sample after sample: scattered into the table level by level.
  std::vector<float> position;     // [S,3]
  std::vector<float> dL_dencoded;  // [S, row]
};

// Takes over the weights of a LibTorch network.
void LoadWeights(const Mlp& from, kernels::TileMlp& to);
// Adds sums of gradients in TileMlp's layout to the gradients of a LibTorch network.
void AddWeightGradients(std::span<const float> sums, const kernels::TileMlp& layout,
                        const Mlp& network);

// A hash encoding and the network behind it, whose first output is the logarithm of density, for
// tiles of samples that fit a core's cache: the formula and the parameters of the LibTorch modules,
// in float, without a LibTorch operation. Only the way back through the table takes whole batches,
// because there a level belongs to one thread.
class TileDensity {
 public:
  // The modules must outlive it.
  TileDensity(const HashEncoding& hash, const Mlp& network,
              kernels::Precision precision = kernels::Precision::kFloat);

  // Takes over what others change between batches. The table is read where it is.
  void Refresh(std::vector<float> level_weights);

  // positions [S,3] in the unit cube -> sigma in 1 / unit of contracted space. The tile may bring
  // footprints.
  void ContractedDensity(std::span<const float> positions, DensityTile& tile) const;
  // The same in 1 / normalized scene unit.
  void Density(std::span<const float> positions, DensityTile& tile) const;

  // Outputs of the network for sample i; the first has become sigma.
  float* Output(DensityTile& tile, std::int64_t i) const;
  int Outputs() const { return network_.Width(network_.Layers()); }

  // Keeps of the tile's samples those whose indices are given, in rising order.
  void Keep(std::span<const std::int64_t> kept, DensityTile& tile) const;

  // The way back for the first `samples` samples, whose Output holds dL/doutput but for the first,
  // which follows from dL_dsigma. Uses the tile up.
  void Backward(std::int64_t samples, std::span<const float> positions,
                std::span<const float> dL_dsigma, DensityTile& tile,
                DensityGradients& gradients) const;

  void Clear(DensityGradients& gradients) const;
  // What reached the positions of the samples that were gathered, through the encoding.
  //   dL_dposition  [S,3], added to
  void AddToPositions(const DensityGradients& gradients, std::span<float> dL_dposition) const;
  // Adds what the threads gathered, in their order, to the gradients of the LibTorch parameters.
  void AddToParameters(std::span<const DensityGradients* const> gradients);

 private:
  int Row() const;  // floats between the encodings of two samples
  void ApplyAntiAliasing(std::int64_t samples, DensityTile& tile) const;

  const HashEncoding& hash_;
  const Mlp& module_;
  kernels::TileMlp network_;
  std::vector<float> level_weights_;
};

}  // namespace nerf
