#include "nerf/field/background.h"

#include <vector>

#include "nerf/effects/background_start.h"
#include "nerf/field/activations.h"
#include "nerf/field/tensor_span.h"

namespace nerf {
namespace {

// A texel is padded to four floats, so that the optimiser updates the map as a sparse table: texels
// without a gradient in a step are not moved by the momentum of earlier steps.
constexpr std::int64_t kColumns = 4;

}  // namespace

Background::Background(const BackgroundOptions& options, ColorEncoding encoding)
    : rows_(options.resolution), encoding_(encoding) {
  table_ = register_parameter("table", torch::zeros({2 * std::int64_t{rows_} * rows_, kColumns}));
}

torch::Tensor Background::Raw() const { return table_.slice(1, 0, 3); }

torch::Tensor Background::forward(const torch::Tensor& directions) {
  TORCH_CHECK(directions.dim() == 2 && directions.size(1) == 3,
              "Background: directions must be [R,3], got ", directions.sizes());
  const torch::Tensor plain = directions.to(torch::kFloat).contiguous();
  const auto d = Span<const float>(plain);
  const std::int64_t rays = directions.size(0);
  std::vector<std::int64_t> index;
  std::vector<float> weight;
  for (std::int64_t r = 0; r < rays; ++r) {
    const auto texels = BackgroundMap::TexelsOf(d.subspan(3 * r).first<3>(), rows_);
    index.insert(index.end(), texels.index.begin(), texels.index.end());
    weight.insert(weight.end(), texels.weight.begin(), texels.weight.end());
  }
  // Cloned, because autograd reads them in the backward pass, when these vectors are gone.
  const torch::Tensor corners =
      Raw().index_select(0, TensorOf(index, {4 * rays}, torch::kLong).clone()).view({rays, 4, 3});
  const torch::Tensor raw =
      (corners * TensorOf(weight, {rays, 4, 1}, table_.scalar_type()).clone()).sum(1);
  return encoding_ == ColorEncoding::kSrgb ? torch::sigmoid(raw) : TruncatedExp(raw);
}

BackgroundMap Background::Map() const {
  const torch::NoGradGuard no_grad;
  const torch::Tensor raw = Raw().detach().to(torch::kFloat).contiguous();
  const auto values = Span<const float>(raw);
  return {rows_, encoding_, {values.begin(), values.end()}};
}

void Background::Initialize(const TargetBatch& batch) {
  const torch::NoGradGuard no_grad;
  BackgroundMap map = Map();
  InitializeBackground(batch.photograph, batch.rays.direction, batch.rgb, map);
  Raw().copy_(TensorOf(map.raw, {table_.size(0), 3}, torch::kFloat));
}

void Background::AddGradient(std::span<const float> dL_draw) {
  const torch::NoGradGuard no_grad;
  const std::vector<float> values(dL_draw.begin(), dL_draw.end());
  const torch::Tensor gradient = torch::zeros_like(table_);
  gradient.slice(1, 0, 3).copy_(TensorOf(values, {table_.size(0), 3}, torch::kFloat));
  torch::Tensor& into = table_.mutable_grad();
  into = into.defined() ? into + gradient : gradient;
}

}  // namespace nerf
