#include "nerf/kernels/mlp.h"

#include <utility>

#include "nerf/kernels/matrix_product.h"

namespace nerf::kernels {

TileMlp::TileMlp(std::vector<int> widths) : widths_(std::move(widths)), offset_{0} {
  for (int l = 0; l < Layers(); ++l) {
    const std::int64_t size =
        static_cast<std::int64_t>(PaddedWidth(widths_[l])) * PaddedWidth(widths_[l + 1]);
    offset_.push_back(offset_.back() + size);
  }
  in_from_out_.assign(offset_.back(), 0.0f);
  out_from_in_.assign(offset_.back(), 0.0f);
}

void TileMlp::Load(std::span<const float* const> weights) {
  for (int l = 0; l < Layers(); ++l) {
    const int inputs = widths_[l], outputs = widths_[l + 1];
    float* const w = &in_from_out_[offset_[l]];
    float* const wt = &out_from_in_[offset_[l]];
    for (int o = 0; o < outputs; ++o) {
      for (int i = 0; i < inputs; ++i) {
        const float value = weights[l][o * inputs + i];
        w[o * PaddedWidth(inputs) + i] = value;
        wt[i * PaddedWidth(outputs) + o] = value;
      }
    }
  }
}

void TileMlp::Forward(std::int64_t samples, std::span<float* const> rows) const {
  for (int l = 0; l < Layers(); ++l) {
    const int inputs = PaddedWidth(widths_[l]), outputs = PaddedWidth(widths_[l + 1]);
    MatrixProduct product;
    product.a = rows[l];
    product.a_row = inputs;
    product.b = &out_from_in_[offset_[l]];
    product.b_row = outputs;
    product.c = rows[l + 1];
    product.c_row = outputs;
    product.rows = samples;
    product.inner = widths_[l];
    product.columns = outputs;
    Multiply(product, l + 1 < Layers() ? Epilogue::kStoreRelu : Epilogue::kStore);
  }
}

void TileMlp::Backward(std::int64_t samples, std::span<float* const> rows,
                       std::span<float> gradients) const {
  for (int l = Layers() - 1; l >= 0; --l) {
    const int inputs = PaddedWidth(widths_[l]), outputs = PaddedWidth(widths_[l + 1]);
    MatrixProduct weight;  // dL/dW [outputs, inputs] += dL/dout^T x in
    weight.a = rows[l + 1];
    weight.a_row = 1;
    weight.a_inner = outputs;
    weight.b = rows[l];
    weight.b_row = inputs;
    weight.c = &gradients[offset_[l]];
    weight.c_row = inputs;
    weight.rows = widths_[l + 1];
    weight.inner = samples;
    weight.columns = inputs;
    Multiply(weight, Epilogue::kAdd);

    MatrixProduct input;  // dL/din [samples, inputs] = dL/dout x W, over the activations
    input.a = rows[l + 1];
    input.a_row = outputs;
    input.b = &in_from_out_[offset_[l]];
    input.b_row = inputs;
    input.c = rows[l];
    input.c_row = inputs;
    input.rows = samples;
    input.inner = widths_[l + 1];
    input.columns = inputs;
    Multiply(input, l > 0 ? Epilogue::kStoreMasked : Epilogue::kStore);
  }
}

void TileMlp::AddGradients(std::span<const float> gradients,
                           std::span<float* const> dL_dweights) const {
  for (int l = 0; l < Layers(); ++l) {
    const int inputs = widths_[l];
    for (int o = 0; o < widths_[l + 1]; ++o) {
      const float* const row = &gradients[offset_[l] + o * PaddedWidth(inputs)];
      for (int i = 0; i < inputs; ++i) dL_dweights[l][o * inputs + i] += row[i];
    }
  }
}

}  // namespace nerf::kernels
