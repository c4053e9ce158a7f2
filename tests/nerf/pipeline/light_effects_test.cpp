#include "nerf/pipeline/light_effects.h"

#include <gtest/gtest.h>

#include "nerf/geometry/directions.h"
#include "nerf/geometry/surface_mesh.h"

namespace nerf {
namespace {

constexpr int kFewDirections = 128;

// The zero level of a function within [-1, 1]^3, of 41 cells a side.
ExtractedSurface SurfaceFrom(const std::function<double(const Eigen::Vector3d&)>& distance) {
  ExtractedSurface surface;
  surface.distance.cell = 0.05;
  surface.distance.origin = Eigen::Vector3d::Constant(-1);
  surface.distance.size = Eigen::Vector3i::Constant(41);
  for (int z = 0; z < 41; ++z) {
    for (int y = 0; y < 41; ++y) {
      for (int x = 0; x < 41; ++x) {
        surface.distance.values.push_back(
            static_cast<float>(distance(surface.distance.PositionOf(x, y, z))));
      }
    }
  }
  surface.mesh = SurfaceMesh(surface.distance);
  return surface;
}

double BallAt(const Eigen::Vector3d& p) { return p.norm() - 0.6; }

// What twelve cameras see of a surface of one material, under a light from above.
LitSurface SeenByCameras(const ExtractedSurface& surface, const MaterialBatch& one) {
  LitSurface lit;
  lit.transport.directions = LightDirections(kFewDirections);
  const auto count = static_cast<std::int64_t>(surface.mesh.vertices.size());
  lit.vertex_position = torch::empty({count, 3});
  lit.vertex_normal = torch::empty({count, 3});
  for (std::int64_t v = 0; v < count; ++v) {
    std::copy_n(surface.mesh.vertices[v].data(), 3, lit.vertex_position.data_ptr<float>() + 3 * v);
    std::copy_n(surface.mesh.normals[v].data(), 3, lit.vertex_normal.data_ptr<float>() + 3 * v);
  }
  const torch::Tensor light =
      0.3 + 8 * lit.transport.directions.select(1, 2).clamp_min(0).pow(16).unsqueeze(1) *
                torch::ones({1, 3});
  lit.lights = {{"", light, {}}};
  MaterialBatch material{one.base_color.expand({count, 3}), {}, {}};
  if (!one.IsMatt()) {
    material.roughness = one.roughness.expand({count});
    material.metallic = one.metallic.expand({count});
  }
  std::vector<torch::Tensor> rows, to_camera, radiance;
  for (int camera = 0; camera < 12; ++camera) {
    const Eigen::Vector3f d = FibonacciDirection(camera, 12).cast<float>();
    const torch::Tensor towards = torch::tensor({d.x(), d.y(), d.z()}).expand({count, 3});
    const torch::Tensor all = torch::arange(count, torch::kLong);
    const torch::Tensor seen =
        Shade({lit.vertex_normal, towards}, material, LightAt(lit.transport, all, light, {})).Sum();
    const torch::Tensor visible = ((lit.vertex_normal * towards).sum(1) > 0.2).nonzero().squeeze(1);
    rows.push_back(visible);
    to_camera.push_back(towards.index_select(0, visible));
    radiance.push_back(seen.index_select(0, visible));
  }
  SurfaceObservations& seen = lit.observations;
  seen.vertex = torch::cat(rows);
  seen.group = torch::zeros_like(seen.vertex);
  seen.position = lit.vertex_position.index_select(0, seen.vertex);
  seen.normal = lit.vertex_normal.index_select(0, seen.vertex);
  seen.to_camera = torch::cat(to_camera);
  seen.radiance = torch::cat(radiance);
  return lit;
}

LightEffects Decide(const ExtractedSurface& surface, LitSurface& lit, MaterialOptions options) {
  options.directions = kFewDirections;
  options.points = 128;
  const Eigen::AlignedBox3d box(Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1));
  return DecideLightEffects(options, surface, MeshRays(surface.mesh), box, 32, 1, true, lit);
}

const MaterialBatch kMatt{torch::full({1, 3}, 0.5), {}, {}};

TEST(LightEffects, AConvexMattBallNeedsNone) {
  const ExtractedSurface ball = SurfaceFrom(BallAt);
  LitSurface lit = SeenByCameras(ball, kMatt);
  const LightEffects effects = Decide(ball, lit, {});
  EXPECT_FALSE(effects.shadows);
  EXPECT_FALSE(effects.bounces);
  EXPECT_FALSE(effects.specular);
  EXPECT_EQ(effects.blocked, 0);
  EXPECT_FALSE(lit.transport.blocker.defined());  // and costs nothing
}

TEST(LightEffects, ABallOverAPlaneShadowsIt) {
  const ExtractedSurface scene =
      SurfaceFrom([](const Eigen::Vector3d& p) { return std::min(BallAt(p), p.z() + 0.7); });
  LitSurface lit = SeenByCameras(scene, kMatt);
  const LightEffects effects = Decide(scene, lit, {});
  EXPECT_TRUE(effects.shadows);
  EXPECT_TRUE(effects.bounces);
  EXPECT_TRUE(lit.transport.blocker.defined());
  EXPECT_TRUE(lit.has_bounces);
}

TEST(LightEffects, ABallOfMetalNeedsACoat) {
  const ExtractedSurface ball = SurfaceFrom(BallAt);
  LitSurface lit =
      SeenByCameras(ball, {torch::full({1, 3}, 0.9), torch::full({1}, 0.35), torch::ones({1})});
  const LightEffects effects = Decide(ball, lit, {});
  EXPECT_TRUE(effects.specular);
  EXPECT_GT(effects.specular_db.value(), kLeastSpecular);
}

TEST(LightEffects, WhatTheUserDecidesIsNotAsked) {
  const ExtractedSurface ball = SurfaceFrom(BallAt);
  LitSurface lit = SeenByCameras(ball, kMatt);
  MaterialOptions options;
  options.shadows = options.specular = LightEffectChoice::kOn;
  options.bounces = LightEffectChoice::kOff;
  const LightEffects effects = Decide(ball, lit, options);
  EXPECT_TRUE(effects.shadows);
  EXPECT_FALSE(effects.bounces);
  EXPECT_TRUE(effects.specular);
  EXPECT_FALSE(effects.blocked.has_value());
  EXPECT_FALSE(effects.specular_db.has_value());
}

}  // namespace
}  // namespace nerf
