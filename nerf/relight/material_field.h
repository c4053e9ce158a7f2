#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>

#include "nerf/field/hash_encoding.h"
#include "nerf/field/mlp.h"
#include "nerf/relight/surface_shading.h"

namespace nerf {

// What the material field knows of surface points.
struct SurfaceProperties {
  MaterialBatch material;
  torch::Tensor normal_offset;  // [P,3] in [-1,1], to be added to the normal of the surface
};

// Material as a function of position: a hash encoding and a network, as the radiance field's.
class MaterialField : public torch::nn::Module {
 public:
  //   box         the space in which it is defined, normalized units
  //   resolution  of the finest level, cells along the longest side
  //   is_matt     without a coat: base colour and normal alone
  MaterialField(const Eigen::AlignedBox3d& box, int resolution, bool is_matt, std::uint64_t seed);

  // positions [P,3], normalized frame. Differentiable in the parameters.
  SurfaceProperties forward(const torch::Tensor& positions);

  const Eigen::AlignedBox3d& Box() const { return box_; }
  bool IsMatt() const { return is_matt_; }

 private:
  Eigen::AlignedBox3d box_;
  bool is_matt_;
  std::shared_ptr<HashEncoding> hash_encoding_;
  std::shared_ptr<Mlp> network_;
};

}  // namespace nerf
