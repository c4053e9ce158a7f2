#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/kernels/matrix_product.h"

namespace nerf::kernels {

// What products round their factors to; sums, activations and weights stay float.
enum class Precision {
  kFloat,
  kBfloat16,  // see bfloat16_product.h
};

// A small fully connected network, ReLU between its layers, no biases, for a tile of samples whose
// activations stay in a core's cache. Activations are rows, one a sample, of PaddedWidth floats
// (matrix_product.h).
class TileMlp {
 public:
  // widths: inputs, hidden layers, outputs.
  explicit TileMlp(std::vector<int> widths, Precision precision = Precision::kFloat);

  int Layers() const { return static_cast<int>(widths_.size()) - 1; }
  int Width(int layer) const { return widths_[layer]; }

  // Takes the weights over. weights[l] is [widths[l + 1], widths[l]], as torch::nn::Linear has
  // them.
  void Load(std::span<const float* const> weights);

  // rows[0] holds the inputs; writes rows[1] ... rows[Layers()], the last being the outputs.
  void Forward(std::int64_t samples, std::span<float* const> rows) const;

  // rows as Forward left them, but with dL/doutput in the last. Every row becomes the gradient of
  // what it held; rows[0] is dL/dinput. Adds dL/dweights to `gradients`.
  void Backward(std::int64_t samples, std::span<float* const> rows,
                std::span<float> gradients) const;

  // A buffer of gradients is this many floats; AddGradients adds layer l of it to dL_dweights[l],
  // in the shape of Load.
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
  std::vector<std::int64_t> offset_;  // [Layers() + 1] first float of each layer below
  std::vector<float> in_from_out_;    // W    [padded outputs, padded inputs] a layer, as gradients
  std::vector<float> out_from_in_;    // W^T  [padded inputs, padded outputs] a layer
  std::vector<std::uint32_t> in_from_out_pairs_, out_from_in_pairs_;  // the same by PairRows
};

}  // namespace nerf::kernels
