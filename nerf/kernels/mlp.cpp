#include "nerf/kernels/mlp.h"

#include <utility>

#include "nerf/kernels/bfloat16_product.h"
#include "nerf/kernels/matrix_product.h"

namespace nerf::kernels {

TileMlp::TileMlp(std::vector<int> widths, Precision precision)
    : widths_(std::move(widths)), precision_(precision), offset_{0} {
  for (int l = 0; l < Layers(); ++l) {
    const std::int64_t size =
        static_cast<std::int64_t>(PaddedWidth(widths_[l])) * PaddedWidth(widths_[l + 1]);
    offset_.push_back(offset_.back() + size);
  }
  in_from_out_.assign(offset_.back(), 0.0f);
  out_from_in_.assign(offset_.back(), 0.0f);
  if (precision == Precision::kBfloat16) {
    in_from_out_pairs_.assign(offset_.back() / 2, 0);
    out_from_in_pairs_.assign(offset_.back() / 2, 0);
  }
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
    if (precision_ == Precision::kFloat) continue;
    const int rows_in = PaddedWidth(inputs), rows_out = PaddedWidth(outputs);
    PairRows(w, rows_in, rows_out, rows_in, &in_from_out_pairs_[offset_[l] / 2]);
    PairRows(wt, rows_out, rows_in, rows_out, &out_from_in_pairs_[offset_[l] / 2]);
  }
}

void TileMlp::Forward(std::int64_t samples, std::span<float* const> rows) const {
  for (int l = 0; l < Layers(); ++l) {
    precision_ == Precision::kFloat ? ForwardLayer(l, samples, rows)
                                    : ForwardLayerInPairs(l, samples, rows);
  }
}

void TileMlp::Backward(std::int64_t samples, std::span<float* const> rows,
                       std::span<float> gradients) const {
  for (int l = Layers() - 1; l >= 0; --l) {
    float* const of_layer = &gradients[offset_[l]];
    precision_ == Precision::kFloat ? BackwardLayer(l, samples, rows, of_layer)
                                    : BackwardLayerInPairs(l, samples, rows, of_layer);
  }
}

void TileMlp::ForwardLayer(int l, std::int64_t samples, std::span<float* const> rows) const {
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
  Multiply(product, ForwardEpilogue(l));
}

void TileMlp::BackwardLayer(int l, std::int64_t samples, std::span<float* const> rows,
                            float* gradients) const {
  const int inputs = PaddedWidth(widths_[l]), outputs = PaddedWidth(widths_[l + 1]);
  MatrixProduct weight;  // dL/dW [outputs, inputs] += dL/dout^T x in
  weight.a = rows[l + 1];
  weight.a_row = 1;
  weight.a_inner = outputs;
  weight.b = rows[l];
  weight.b_row = inputs;
  weight.c = gradients;
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
  Multiply(input, BackwardEpilogue(l));
}

namespace {

// The packed factors of the current product, one buffer per thread.
std::uint32_t* Pairs(std::vector<std::uint32_t>& storage, std::int64_t size) {
  if (static_cast<std::int64_t>(storage.size()) < size) storage.resize(size);
  return storage.data();
}
thread_local std::vector<std::uint32_t> first_factor, second_factor;

}  // namespace

void TileMlp::ForwardLayerInPairs(int l, std::int64_t samples, std::span<float* const> rows) const {
  const int inputs = PaddedWidth(widths_[l]), outputs = PaddedWidth(widths_[l + 1]);
  Bfloat16Product product;
  std::uint32_t* const in = Pairs(first_factor, samples * inputs / 2);
  PairColumns(rows[l], inputs, samples, inputs, in);
  product.a = in;
  product.a_row = inputs / 2;
  product.b = &out_from_in_pairs_[offset_[l] / 2];
  product.b_row = outputs;
  product.c = rows[l + 1];
  product.c_row = outputs;
  product.rows = samples;
  product.inner = (widths_[l] + 1) / 2;
  product.columns = outputs;
  Multiply(product, ForwardEpilogue(l));
}

void TileMlp::BackwardLayerInPairs(int l, std::int64_t samples, std::span<float* const> rows,
                                   float* gradients) const {
  const int inputs = PaddedWidth(widths_[l]), outputs = PaddedWidth(widths_[l + 1]);
  const std::int64_t sample_pairs = (samples + 1) / 2;
  Bfloat16Product weight;
  std::uint32_t* const dL_dout = Pairs(first_factor, sample_pairs * outputs);
  std::uint32_t* const in = Pairs(second_factor, sample_pairs * inputs);
  PairRows(rows[l + 1], outputs, samples, outputs, dL_dout);
  PairRows(rows[l], inputs, samples, inputs, in);
  weight.a = dL_dout;
  weight.a_row = 1;
  weight.a_inner = outputs;
  weight.b = in;
  weight.b_row = inputs;
  weight.c = gradients;
  weight.c_row = inputs;
  weight.rows = widths_[l + 1];
  weight.inner = sample_pairs;
  weight.columns = inputs;
  Multiply(weight, Epilogue::kAdd);

  Bfloat16Product input;
  PairColumns(rows[l + 1], outputs, samples, outputs, dL_dout);  // smaller than before
  input.a = dL_dout;
  input.a_row = outputs / 2;
  input.b = &in_from_out_pairs_[offset_[l] / 2];
  input.b_row = inputs;
  input.c = rows[l];
  input.c_row = inputs;
  input.rows = samples;
  input.inner = (widths_[l + 1] + 1) / 2;
  input.columns = inputs;
  Multiply(input, BackwardEpilogue(l));
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
