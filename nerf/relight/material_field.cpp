#include "nerf/relight/material_field.h"

#include "nerf/base/random.h"

namespace nerf {
namespace {

constexpr int kHidden = 32;
constexpr int kOutputs = 3 + 1 + 1 + 3;  // base colour, roughness, metallic, normal
constexpr double kDielectricBias = -3;   // metals are few

kernels::HashGridOptions GridOf(int resolution) {
  kernels::HashGridOptions grid;
  grid.levels = 8;
  grid.features = 2;
  grid.log2_table_size = 16;
  grid.base_resolution = 8;
  grid.max_resolution = std::max(grid.base_resolution, resolution);
  return grid;
}

}  // namespace

MaterialField::MaterialField(const Eigen::AlignedBox3d& box, int resolution, bool is_matt,
                             std::uint64_t seed)
    : box_(box),
      is_matt_(is_matt),
      hash_encoding_(std::make_shared<HashEncoding>(GridOf(resolution), seed)),
      network_(
          std::make_shared<Mlp>(std::vector<std::int64_t>{hash_encoding_->Layout().OutputSize(),
                                                          kHidden, kHidden, kOutputs},
                                Mix64(seed))) {
  register_module("hash_encoding", hash_encoding_);
  register_module("network", network_);
}

SurfaceProperties MaterialField::forward(const torch::Tensor& positions) {
  const double side = box_.sizes().maxCoeff();
  const torch::Tensor corner =
      torch::tensor({box_.min().x(), box_.min().y(), box_.min().z()}, positions.options());
  const torch::Tensor in_cube = ((positions - corner) / side).clamp(0, 1);
  const torch::Tensor raw = network_->forward(hash_encoding_->forward(in_cube));
  SurfaceProperties result;
  result.material.base_color = torch::sigmoid(raw.slice(1, 0, 3));
  if (!is_matt_) {
    result.material.roughness =
        kLeastRoughness + (1 - kLeastRoughness) * torch::sigmoid(raw.select(1, 3));
    result.material.metallic = torch::sigmoid(raw.select(1, 4) + kDielectricBias);
  }
  result.normal_offset = torch::tanh(raw.slice(1, 5, 8));
  return result;
}

}  // namespace nerf
