#include "nerf/train/material_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "nerf/geometry/directions.h"
#include "nerf/geometry/level_set_mesh.h"
#include "nerf/render/non_finite_error.h"

namespace nerf {
namespace {

constexpr int kDirections = 256;

// A ball of two colours beside another, under a light that is brighter from one side.
struct Scene {
  Mesh mesh;
  LightTransport transport;
  torch::Tensor position, normal, light, albedo;
};

Scene MakeScene() {
  ScalarGrid grid;
  grid.cell = 0.1;
  grid.origin = Eigen::Vector3d(-1, -1, -1);
  grid.size = {26, 21, 21};
  for (int z = 0; z < grid.size.z(); ++z) {
    for (int y = 0; y < grid.size.y(); ++y) {
      for (int x = 0; x < grid.size.x(); ++x) {
        const Eigen::Vector3d p = grid.PositionOf(x, y, z);
        grid.values.push_back(static_cast<float>(
            std::min(p.norm() - 0.6, (p - Eigen::Vector3d(1, 0, 0)).norm() - 0.3)));
      }
    }
  }
  Scene scene;
  scene.mesh = LevelSetMesh(grid, 0);
  scene.transport = TraceLight(scene.mesh, MeshRays(scene.mesh), kDirections, 0.1f);
  const auto count = static_cast<std::int64_t>(scene.mesh.vertices.size());
  scene.position = torch::empty({count, 3});
  scene.normal = torch::empty({count, 3});
  for (std::int64_t v = 0; v < count; ++v) {
    std::copy_n(scene.mesh.vertices[v].data(), 3, scene.position.data_ptr<float>() + 3 * v);
    std::copy_n(scene.mesh.normals[v].data(), 3, scene.normal.data_ptr<float>() + 3 * v);
  }
  const torch::Tensor is_right = (scene.position.select(1, 1) > 0).to(torch::kFloat).unsqueeze(1);
  scene.albedo = is_right * torch::tensor({0.7f, 0.3f, 0.2f}) +
                 (1 - is_right) * torch::tensor({0.2f, 0.4f, 0.6f});
  scene.light = 0.2 + 1.2 * scene.transport.directions.select(1, 2).clamp_min(0).unsqueeze(1) *
                          torch::ones({1, 3});
  return scene;
}

// What cameras in some directions see of all vertices, with the light that these reflect.
SurfaceObservations Observe(const Scene& scene) {
  const std::int64_t count = scene.position.size(0);
  const MaterialBatch material{scene.albedo, torch::full({count}, 0.6), torch::zeros({count})};
  const torch::Tensor all = torch::arange(count, torch::kLong);
  torch::Tensor radiance = torch::zeros({count, 3});
  for (int bounce = 0; bounce < 4; ++bounce) {
    const ReflectedLight out = Shade({scene.normal, scene.normal}, material,
                                     LightAt(scene.transport, all, scene.light, radiance));
    radiance = out.diffuse + out.specular;
  }
  std::vector<torch::Tensor> rows, to_camera, seen;
  for (int camera = 0; camera < 12; ++camera) {
    const Eigen::Vector3f direction = FibonacciDirection(camera, 12).cast<float>();
    const torch::Tensor towards =
        torch::tensor({direction.x(), direction.y(), direction.z()}).expand({count, 3});
    const ReflectedLight out = Shade({scene.normal, towards}, material,
                                     LightAt(scene.transport, all, scene.light, radiance));
    const torch::Tensor visible = ((scene.normal * towards).sum(1) > 0.2).nonzero().squeeze(1);
    rows.push_back(visible);
    to_camera.push_back(towards.index_select(0, visible));
    seen.push_back((out.diffuse + out.specular).index_select(0, visible));
  }
  SurfaceObservations observations;
  observations.vertex = torch::cat(rows);
  observations.position = scene.position.index_select(0, observations.vertex);
  observations.normal = scene.normal.index_select(0, observations.vertex);
  observations.to_camera = torch::cat(to_camera);
  observations.radiance = torch::cat(seen);
  observations.group = torch::zeros_like(observations.vertex);
  return observations;
}

// What the photographs of Observe show, under a light that is known, or not: undefined.
LitSurface LitBy(const Scene& scene, const torch::Tensor& light) {
  LitSurface lit;
  lit.observations = Observe(scene);
  lit.transport = scene.transport;
  lit.lights = {{"", light, {}}};
  lit.vertex_position = scene.position;
  lit.vertex_normal = scene.normal;
  return lit;
}

std::shared_ptr<MaterialField> FieldOf(const Scene& scene) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : scene.mesh.vertices) box.extend(vertex.cast<double>());
  return std::make_shared<MaterialField>(box, 32, false, 1);
}

// The root mean square difference from the albedo, after one scale a channel if it is asked for.
double AlbedoError(const Scene& scene, torch::Tensor found, bool is_scaled) {
  if (is_scaled)
    found = found * std::get<0>((scene.albedo / found.clamp_min(1e-3)).median(0, true));
  return (found - scene.albedo).square().mean().sqrt().item<double>();
}

torch::Tensor AlbedoOf(const Scene& scene, MaterialField& field) {
  const torch::NoGradGuard no_grad;
  return field.forward(scene.position).material.base_color;
}

double Fit(const Scene& scene, const std::shared_ptr<MaterialField>& field, int steps,
           const torch::Tensor& light, torch::Tensor* found_light = nullptr) {
  MaterialOptions options;
  options.points = 256;
  MaterialFit fit(LitBy(scene, light), field, options, 1);
  double error = 0;
  for (int i = 0; i < steps; ++i) error = fit.Step(static_cast<double>(i) / steps);
  if (found_light != nullptr) *found_light = fit.Environments()[0];
  return error;
}

TEST(MaterialFit, FindsAlbedoUnderAKnownLight) {
  const Scene scene = MakeScene();
  const auto field = FieldOf(scene);
  EXPECT_LT(Fit(scene, field, 300, scene.light), 4e-4);
  EXPECT_LT(AlbedoError(scene, AlbedoOf(scene, *field), false), 0.05);
}

TEST(MaterialFit, FindsLightAndAlbedoButForTheirScale) {
  const Scene scene = MakeScene();
  const auto field = FieldOf(scene);
  torch::Tensor light;
  EXPECT_LT(Fit(scene, field, 400, {}, &light), 4e-4);
  // Half the error of what is observed, taken for the albedo.
  const torch::Tensor observed = MeanRadiance(Observe(scene), 1, scene.position.size(0))[0];
  EXPECT_LT(AlbedoError(scene, AlbedoOf(scene, *field), true),
            AlbedoError(scene, observed, true) / 2);
  // The pin of the scale, and where the light comes from.
  EXPECT_NEAR(light.mean().item<double>(), MaterialFit::kMeanRadiance, 0.25);
  const torch::Tensor up = (scene.transport.directions.select(1, 2) > 0.3).nonzero().squeeze(1);
  const torch::Tensor down = (scene.transport.directions.select(1, 2) < -0.3).nonzero().squeeze(1);
  EXPECT_GT(light.index_select(0, up).mean().item<double>(),
            2 * light.index_select(0, down).mean().item<double>());
}

// One sun at a time, in a dark room: its scale is known, and so is the albedo's.
TEST(MaterialFit, FindsAlbedoUnderOneSunAtATime) {
  const Scene scene = MakeScene();
  const MeshRays rays(scene.mesh);
  const std::int64_t count = scene.position.size(0);
  const torch::Tensor to_camera = scene.normal;  // seen from the front
  const MaterialBatch material{scene.albedo, {}, {}};
  LitSurface lit;
  lit.transport = scene.transport;
  lit.vertex_position = scene.position;
  lit.vertex_normal = scene.normal;
  std::vector<torch::Tensor> radiance, visible_rows, groups;
  std::vector<std::vector<Lamp>> lamps;
  for (int k = 0; k < 6; ++k) {
    lit.lights.push_back({std::to_string(k),
                          torch::zeros({kDirections, 3}),
                          {DirectionalLight{FibonacciDirection(k, 6), {3, 3, 3}}}});
    lamps.push_back(lit.lights.back().lamps);
  }
  const LampTable table(lamps);
  for (int k = 0; k < 6; ++k) {
    const torch::Tensor group = torch::full({count}, k, torch::kLong);
    const torch::Tensor visible = table.Visibility(scene.position, scene.normal, group, rays, 0.1f);
    const LampLight light = table.At(scene.position, group, 0);
    const auto reflect = [&](const torch::Tensor& indirect) {
      torch::Tensor sum =
          ShadeFrom({scene.normal, to_camera}, material, light.to_light, light.irradiance * visible)
              .Sum();
      if (!indirect.defined()) return sum;
      const torch::Tensor dark = torch::zeros({kDirections, 3});
      return sum +
             Shade({scene.normal, to_camera}, material,
                   LightAt(scene.transport, torch::arange(count, torch::kLong), dark, indirect))
                 .Sum();
    };
    radiance.push_back(reflect(reflect({})));
    visible_rows.push_back(visible);
    groups.push_back(group);
  }
  SurfaceObservations& seen = lit.observations;
  seen.position = scene.position.repeat({6, 1});
  seen.normal = scene.normal.repeat({6, 1});
  seen.to_camera = to_camera.repeat({6, 1});
  seen.radiance = torch::cat(radiance);
  seen.vertex = torch::arange(count, torch::kLong).repeat({6});
  seen.group = torch::cat(groups);
  lit.lamp_visibility = torch::cat(visible_rows);
  lit.vertex_lamp_visibility = torch::stack(visible_rows);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : scene.mesh.vertices) box.extend(vertex.cast<double>());
  const auto field = std::make_shared<MaterialField>(box, 32, true, 1);
  MaterialOptions options;
  options.points = 256;
  MaterialFit fit(lit, field, options, 1);
  for (int i = 0; i < 300; ++i) fit.Step(i / 300.0);
  EXPECT_LT(AlbedoError(scene, AlbedoOf(scene, *field), false), 0.04);
}

TEST(MaterialFit, GoesOnWithTheSameBits) {
  const Scene scene = MakeScene();
  const LitSurface lit = LitBy(scene, {});
  MaterialOptions options;
  options.points = 64;
  const auto whole = FieldOf(scene), parts = FieldOf(scene);
  MaterialFit uninterrupted(lit, whole, options, 1);
  for (int i = 0; i < 8; ++i) uninterrupted.Step(i / 8.0);
  std::map<std::string, torch::Tensor> state;
  {
    MaterialFit first(lit, parts, options, 1);
    for (int i = 0; i < 3; ++i) first.Step(i / 8.0);
    first.AddTo(state);
    for (auto& item : state) item.second = item.second.clone();
  }
  MaterialFit second(lit, parts, options, 1);
  second.LoadFrom(state, 3);
  for (int i = 3; i < 8; ++i) second.Step(i / 8.0);
  const auto a = whole->parameters(), b = parts->parameters();
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(torch::equal(a[i], b[i])) << i;
  EXPECT_TRUE(torch::equal(uninterrupted.Environments(), second.Environments()));
}

TEST(MaterialFit, TheSameSeedGivesTheSameBits) {
  const Scene scene = MakeScene();
  const auto first = FieldOf(scene), second = FieldOf(scene);
  Fit(scene, first, 5, {});
  Fit(scene, second, 5, {});
  const auto a = first->parameters(), b = second->parameters();
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(torch::equal(a[i], b[i]));
}

TEST(MaterialFit, ALossThatIsNotFiniteNamesItsStep) {
  const Scene scene = MakeScene();
  LitSurface lit = LitBy(scene, {});
  lit.observations.radiance.fill_(std::numeric_limits<float>::quiet_NaN());
  MaterialFit fit(lit, FieldOf(scene), {}, 1);
  EXPECT_THROW(fit.Step(0), NonFiniteError);
}

}  // namespace
}  // namespace nerf
