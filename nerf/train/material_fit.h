#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nerf/config/material_options.h"
#include "nerf/relight/light_group.h"
#include "nerf/relight/light_transport.h"
#include "nerf/relight/material_field.h"
#include "nerf/relight/surface_observations.h"
#include "nerf/train/optimizer.h"

namespace nerf {

// A surface as photographs show it, with what stands between it and the light.
struct LitSurface {
  SurfaceObservations observations;
  LightTransport transport;  // without blockers: no shadows
  bool has_bounces = true;   // light that other parts of the surface reflect
  std::vector<LightGroup> lights;
  // Of lamps; undefined where there are none. Their shadows, see LampTable::Visibility:
  torch::Tensor lamp_visibility;         // [N,K] at the observations
  torch::Tensor vertex_lamp_visibility;  // [G,V,K] at the vertices
  // The vertices of the surface.
  torch::Tensor vertex_position, vertex_normal;  // [V,3]
};

// Finds the material of a surface, and the light that shines on it, from photographs: Adam on the
// difference between what the surface reflects (Shade) and what is observed, in sRGB. Light that
// other parts of the surface reflect is that which photographs show there, or under lamps alone
// what the materials found so far reflect.
//
// The product of albedo and light is all that photographs tell. Where a light is not given, its
// scale is pinned by a prior: the mean radiance over all directions is white and near
// kMeanRadiance, so that a matt surface of albedo 0.8 in full light is just not clipped.
class MaterialFit {
 public:
  static constexpr double kMeanRadiance = 0.6;

  // Throws c10::Error where nothing is observed.
  MaterialFit(const LitSurface& surface, std::shared_ptr<MaterialField> field,
              const MaterialOptions& options, std::uint64_t seed);

  // One step at a position of the fit, 0 to 1. Returns the mean squared error, of sRGB values. The
  // same seed gives the same bits.
  // Throws NonFiniteError naming the step.
  double Step(double progress);

  std::int64_t Steps() const { return step_; }
  // [G,D,3] the environments, found or given.
  torch::Tensor Environments() const;

  // The state of an interrupted fit, without the parameters of the material field; with them, it
  // goes on with the same bits.
  void AddTo(std::map<std::string, torch::Tensor>& tensors) const;
  void LoadFrom(const std::map<std::string, torch::Tensor>& tensors, std::int64_t step);

 private:
  struct Batch;
  Batch DrawBatch() const;
  torch::Tensor LightOfGroups() const;
  torch::Tensor Reflect(const Batch& batch, const SurfaceProperties& found,
                        const torch::Tensor& light) const;
  torch::Tensor Priors(const Batch& batch, const SurfaceProperties& found,
                       const torch::Tensor& light) const;
  void UpdateRadiance();

  const LitSurface surface_;
  std::shared_ptr<MaterialField> field_;
  MaterialOptions options_;
  std::uint64_t seed_;
  LampTable lamps_;
  torch::Tensor known_light_;               // [G,D,3], 0 where it is not known
  torch::Tensor unknown_;                   // [U] int64, the groups of which the light is not known
  torch::Tensor log_light_;                 // [U,D,3]
  torch::Tensor radiance_;                  // [G,V,3] of the vertices; undefined: without bounces
  std::vector<std::int64_t> lit_by_lamps_;  // groups whose radiance is that of the materials
  Adam material_optimizer_;
  std::optional<Adam> light_optimizer_;
  std::int64_t step_ = 0;
};

}  // namespace nerf
