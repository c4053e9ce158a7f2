#include "nerf/render/density_tile.h"

#include <algorithm>
#include <cmath>

#include "nerf/base/parallel.h"
#include "nerf/base/stopwatch.h"
#include "nerf/effects/anti_aliasing.h"
#include "nerf/field/activations.h"
#include "nerf/field/density.h"
#include "nerf/field/tensor_span.h"
#include "nerf/kernels/activations.h"
#include "nerf/kernels/hash_encoding_tile.h"
#include "nerf/kernels/matrix_product.h"

namespace nerf {

using kernels::PaddedWidth;
using kernels::TileMlp;

namespace {

// The gradient of a parameter, to accumulate into; created as zeros if undefined.
float* GradientOf(const torch::Tensor& parameter) {
  torch::Tensor& gradient = parameter.mutable_grad();
  if (!gradient.defined()) gradient = torch::zeros_like(parameter).detach();
  return gradient.data_ptr<float>();
}

// RadialShrinkage of one position.
float ShrinkageOf(const float* position) {
  float square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float y = 4.0f * (position[axis] - 0.5f);
    square += y * y;
  }
  if (square <= 1.0f) return 1.0f;
  const float rest = std::max(0.0f, 2.0f - std::sqrt(square));
  return rest * rest;
}

}  // namespace

void TileRows::Resize(const TileMlp& mlp, std::int64_t samples) {
  storage.resize(mlp.Layers() + 1);
  rows.resize(mlp.Layers() + 1);
  for (int l = 0; l <= mlp.Layers(); ++l) {
    const std::size_t size = samples * PaddedWidth(mlp.Width(l));
    if (storage[l].size() < size) storage[l].resize(size, 0.0f);
    rows[l] = storage[l].data();
  }
}

void LoadWeights(const Mlp& from, TileMlp& to) {
  std::vector<const float*> weights;
  for (int l = 0; l < to.Layers(); ++l) weights.push_back(Span<const float>(from.Weight(l)).data());
  to.Load(weights);
}

void AddWeightGradients(std::span<const float> sums, const TileMlp& layout, const Mlp& network) {
  std::vector<float*> gradients;
  for (int l = 0; l < layout.Layers(); ++l) gradients.push_back(GradientOf(network.Weight(l)));
  layout.AddGradients(sums, gradients);
}

TileDensity::TileDensity(const HashEncoding& hash, const Mlp& network, kernels::Precision precision)
    : hash_(hash), module_(network), network_(network.Widths(), precision) {
  TORCH_CHECK(hash.Table().scalar_type() == torch::kFloat,
              "TileDensity: parameters must be float, not ", hash.Table().scalar_type());
}

int TileDensity::Row() const { return PaddedWidth(network_.Width(0)); }

void TileDensity::Refresh(std::vector<float> level_weights) {
  LoadWeights(module_, network_);
  level_weights_ = std::move(level_weights);
}

void TileDensity::ContractedDensity(std::span<const float> positions, DensityTile& tile) const {
  LapTimer timer;
  const auto samples = static_cast<std::int64_t>(positions.size() / 3);
  tile.activations.Resize(network_, samples);
  kernels::HashEncodeTile(hash_.Layout(), Span<const float>(hash_.Table()).data(), positions.data(),
                          samples, level_weights_, tile.activations.rows[0], Row());
  tile.level_weights.clear();
  if (!tile.footprint.empty()) {
    tile.level_weights = AntiAliasingWeights(hash_.Layout(), tile.footprint);
    ApplyAntiAliasing(samples, tile);
  }
  timer.Lap(tile.seconds.encoding);
  network_.Forward(samples, tile.activations.rows);
  tile.sigma.resize(samples);
  for (std::int64_t i = 0; i < samples; ++i) tile.sigma[i] = *Output(tile, i);
  kernels::TruncatedExp(tile.sigma, static_cast<float>(kLogDensityBias),
                        static_cast<float>(kExpLimit));
  timer.Lap(tile.seconds.networks);
}

// Scales the encodings in the forward pass, and their gradients in the backward pass.
void TileDensity::ApplyAntiAliasing(std::int64_t samples, DensityTile& tile) const {
  const std::int64_t levels = static_cast<std::int64_t>(hash_.Layout().levels.size());
  const int features = hash_.Layout().features;
  float* const rows = tile.activations.rows[0];
  for (std::int64_t i = 0; i < samples; ++i) {
    for (std::int64_t l = 0; l < levels; ++l) {
      const float weight = tile.level_weights[i * levels + l];
      if (weight == 1) continue;
      for (int f = 0; f < features; ++f) rows[i * Row() + l * features + f] *= weight;
    }
  }
}

void TileDensity::Density(std::span<const float> positions, DensityTile& tile) const {
  ContractedDensity(positions, tile);
  for (std::size_t i = 0; i < tile.sigma.size(); ++i) {
    tile.sigma[i] *= ShrinkageOf(&positions[3 * i]);
  }
}

float* TileDensity::Output(DensityTile& tile, std::int64_t i) const {
  return tile.activations.rows[network_.Layers()] + i * PaddedWidth(Outputs());
}

void TileDensity::Keep(std::span<const std::int64_t> kept, DensityTile& tile) const {
  for (std::size_t to = 0; to < kept.size(); ++to) {
    const auto from = static_cast<std::size_t>(kept[to]);
    if (from == to) continue;
    tile.sigma[to] = tile.sigma[from];
    for (int l = 0; l <= network_.Layers(); ++l) {
      const std::size_t width = PaddedWidth(network_.Width(l));
      float* const rows = tile.activations.rows[l];
      std::copy_n(rows + from * width, width, rows + to * width);
    }
    if (!tile.level_weights.empty()) {
      const std::size_t levels = hash_.Layout().levels.size();
      std::copy_n(&tile.level_weights[from * levels], levels, &tile.level_weights[to * levels]);
    }
  }
  tile.sigma.resize(kept.size());
}

void TileDensity::Backward(std::int64_t samples, std::span<const float> positions,
                           std::span<const float> dL_dsigma, DensityTile& tile,
                           DensityGradients& gradients) const {
  LapTimer timer;
  for (std::int64_t i = 0; i < samples; ++i) {
    *Output(tile, i) = dL_dsigma[i] * tile.sigma[i];  // sigma = exp(output) * shrinkage
  }
  network_.Backward(samples, tile.activations.rows, gradients.network);
  timer.Lap(tile.seconds.networks);
  if (!tile.level_weights.empty()) ApplyAntiAliasing(samples, tile);
  const float* const encoded = tile.activations.rows[0];
  gradients.position.insert(gradients.position.end(), positions.begin(),
                            positions.begin() + 3 * samples);
  gradients.dL_dencoded.insert(gradients.dL_dencoded.end(), encoded, encoded + samples * Row());
  timer.Lap(tile.seconds.encoding);
}

void TileDensity::Clear(DensityGradients& gradients) const {
  gradients.network.assign(network_.GradientSize(), 0.0f);
  gradients.position.clear();
  gradients.dL_dencoded.clear();
}

void TileDensity::AddToPositions(const DensityGradients& gradients,
                                 std::span<float> dL_dposition) const {
  kernels::HashEncodePositionBackward<float>(
      hash_.Layout(), Span<const float>(hash_.Table()), gradients.position, gradients.dL_dencoded,
      Row(), level_weights_, dL_dposition, 0,
      static_cast<std::int64_t>(gradients.position.size() / 3));
}

void TileDensity::AddToParameters(std::span<const DensityGradients* const> gradients) {
  for (const DensityGradients* part : gradients) {
    AddWeightGradients(part->network, network_, module_);
  }
  float* const dL_dtable = GradientOf(hash_.Table());
  const auto levels = static_cast<std::int64_t>(hash_.Layout().levels.size());
  ParallelForEach(levels, [&](std::int64_t item) {
    const auto level = static_cast<int>(levels - 1 - item);  // the finest first: they take longest
    for (const DensityGradients* part : gradients) {
      kernels::HashScatterLevel(hash_.Layout(), level, level_weights_[level], part->position.data(),
                                part->dL_dencoded.data(), Row(),
                                static_cast<std::int64_t>(part->position.size() / 3), dL_dtable);
    }
  });
}

}  // namespace nerf
