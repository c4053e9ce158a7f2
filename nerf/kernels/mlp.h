#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/kernels/matrix_product.h"

namespace nerf::kernels {

// The type to which products round their factors; sums, activations and weights remain float.
enum class Precision {
  kFloat,
  kBfloat16,  // see bfloat16_product.h
};

// A small fully connected network with ReLU between its layers and no biases, for a tile of samples
// whose activations stay in a core's cache. Activations are stored as one row of PaddedWidth floats
// per sample (matrix_product.h).
class TileMlp {
 public:
  //   widths  inputs, hidden layers, outputs
  explicit TileMlp(std::vector<int> widths, Precision precision = Precision::kFloat);

  int Layers() const { return static_cast<int>(widths_.size()) - 1; }
  int Width(int layer) const { return widths_[layer]; }

  // Copies the weights.
  //   weights[l]  [widths[l + 1], widths[l]], as in torch::nn::Linear
  void Load(std::span<const float* const> weights);

  // The forward pass.
  //   rows  rows[0] holds the inputs; rows[1] ... rows[Layers()] are written, the last: outputs
  void Forward(std::int64_t samples, std::span<float* const> rows) const;

  // The backward pass.
  //   rows       as Forward left them, with dL/doutput in the last; each is replaced by the
  //              gradient of its values, rows[0] by dL/dinput
  //   gradients  [GradientSize()], to which dL/dweights is added
  void Backward(std::int64_t samples, std::span<float* const> rows,
                std::span<float> gradients) const;

  // The size of a buffer of gradients. AddGradients adds layer l of it to dL_dweights[l], in the
  // shape of Load.
  std::int64_t GradientSize() const { return offset_.back(); }
  void AddGradients(std::span<const float> gradients, std::span<float* const> dL_dweights) const;

 private:
  Epilogue ForwardEpilogue(int layer) const {
    return layer + 1 < Layers() ? Epilogue::kStoreRelu : Epilogue::kStore;
  }
  static Epilogue BackwardEpilogue(int layer) {
    return layer > 0 ? Epilogue::kStoreMasked : Epilogue::kStore;
  }
  void ForwardLayer(int layer, std::int64_t samples, std::span<float* const> rows) const;
  void BackwardLayer(int layer, std::int64_t samples, std::span<float* const> rows,
                     float* gradients) const;
  void ForwardLayerInPairs(int layer, std::int64_t samples, std::span<float* const> rows) const;
  void BackwardLayerInPairs(int layer, std::int64_t samples, std::span<float* const> rows,
                            float* gradients) const;

  std::vector<int> widths_;
  Precision precision_;
  std::vector<std::int64_t> offset_;  // [Layers() + 1] first float of each layer in those below
  std::vector<float> in_from_out_;    // per layer: W    [padded outputs, padded inputs]
  std::vector<float> out_from_in_;    // per layer: W^T  [padded inputs, padded outputs]
  std::vector<std::uint32_t> in_from_out_pairs_, out_from_in_pairs_;  // the same, by PairRows
};

}  // namespace nerf::kernels
