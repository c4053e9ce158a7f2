// Light on its way to a surface, where it is hard: rows 53 to 55 and 61 of the hard cases.
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "nerf/geometry/level_set_mesh.h"
#include "nerf/geometry/mesh_rays.h"
#include "nerf/relight/environment_light.h"
#include "nerf/relight/light_transport.h"
#include "nerf/selfcheck/numeric_case.h"

namespace nerf {
namespace {

constexpr double kCellSide = 0.05;
constexpr auto kBegin = static_cast<float>(1.5 * kCellSide);  // of shadow rays

// The zero level of a function within [-1, 1]^3.
Mesh MeshOf(const std::function<double(const Eigen::Vector3d&)>& distance) {
  ScalarGrid grid;
  grid.cell = kCellSide;
  grid.origin = Eigen::Vector3d::Constant(-1);
  grid.size = Eigen::Vector3i::Constant(41);
  for (int z = 0; z < 41; ++z) {
    for (int y = 0; y < 41; ++y) {
      for (int x = 0; x < 41; ++x) {
        grid.values.push_back(static_cast<float>(distance(grid.PositionOf(x, y, z))));
      }
    }
  }
  return LevelSetMesh(grid, 0);
}

// Row 53: a lamp of one texel gives all its power, wherever it is.
double OneBrightTexelKeepsItsPower() {
  WorstError worst;
  for (const int y : {0, 7, 31}) {
    Image image(64, 32, 3, ColorEncoding::kLinear);
    for (int c = 0; c < 3; ++c) image.At(11, y)[c] = 1e6f;
    const EnvironmentMap map(image, "one texel");
    const torch::Tensor radiance =
        RadianceFrom(map, LightDirections(512), Eigen::Matrix3d::Identity());
    // The mean over what is nearest to a direction, so that its solid angle times it is the power.
    double power = 0;
    std::vector<double> solid_angle(512, 0);
    const torch::Tensor directions = LightDirections(512);
    for (int v = 0; v < map.height(); ++v) {
      for (int u = 0; u < map.width(); ++u) {
        const Eigen::Vector3f d = map.Direction(u, v).cast<float>();
        const torch::Tensor cosine =
            torch::matmul(directions, torch::tensor({d.x(), d.y(), d.z()}));
        solid_angle[static_cast<std::size_t>(cosine.argmax().item<std::int64_t>())] +=
            map.SolidAngle(v);
      }
    }
    for (std::size_t d = 0; d < 512; ++d) {
      power += solid_angle[d] * radiance[static_cast<std::int64_t>(d)][0].item<double>();
    }
    worst.AddRelative(power, 1e6 * map.SolidAngle(y));
  }
  return worst.Get();
}

double AMapTurnedOnceIsTheSame() {
  Image image(64, 32, 3, ColorEncoding::kLinear);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = 1 + static_cast<float>(std::sin(static_cast<double>(i)));
  }
  const EnvironmentMap map(image, "waves");
  const torch::Tensor directions = LightDirections(128);
  const auto radiance = [&](double degrees) {
    return RadianceFrom(map, directions, TurnedMap(Eigen::Matrix3d::Identity(), degrees));
  };
  return (radiance(360) - radiance(0)).abs().max().item<double>();
}

double ABlackEnvironmentLeavesBlack() {
  const torch::Tensor normal = torch::tensor({0.f, 0.f, 1.f}).view({1, 3});
  ArrivingLight light;
  light.directions = LightDirections(256);
  light.radiance = torch::zeros({256, 3});
  return Shade({normal, normal}, {torch::ones({1, 3}), torch::full({1}, 0.3f), torch::ones({1})},
               light)
      .Sum()
      .abs()
      .max()
      .item<double>();
}

// Row 54: where there is no normal, nothing is traced, and nothing is NaN.
double APointWithoutNormalIsNotShaded() {
  WorstError worst;
  Mesh ball = MeshOf([](const Eigen::Vector3d& p) { return p.norm() - 0.5; });
  for (Eigen::Vector3f& normal : ball.normals) normal.setZero();
  const MeshRays rays(ball);
  const auto hit = rays.FirstHit({2, 0, 0}, {-1, 0, 0});
  worst.Require(hit.has_value());
  if (hit) worst.Require(NormalAt(ball, *hit).isZero());
  const LightTransport transport = TraceLight(ball, rays, 64, kBegin);
  worst.Require((transport.blocker == LightTransport::kOpen).all().item<bool>());
  worst.Add(BlockedShare(ball, rays, kBegin));
  return worst.Get();
}

// Row 55: an uneven ball does not shadow itself.
double ABallDoesNotShadowItself() {
  const Mesh ball = MeshOf([](const Eigen::Vector3d& p) {
    return p.norm() - 0.6 + 0.01 * kCellSide * std::sin(40 * p.x()) * std::sin(37 * p.y());
  });
  return BlockedShare(ball, MeshRays(ball), kBegin);
}

// Row 55: a sphere above a plane blocks (R / h)^2 of a point below it.
double ASoftShadowIsAsDeepAsTheSphereIsLarge() {
  const Mesh scene = MeshOf([](const Eigen::Vector3d& p) {
    return std::min(p.z() + 0.8, (p - Eigen::Vector3d(0, 0, 0.2)).norm() - 0.5);
  });
  const MeshRays rays(scene);
  const LightTransport transport = TraceLight(scene, rays, 2048, kBegin);
  std::int64_t below = 0;
  double nearest = 2;
  for (std::size_t v = 0; v < scene.vertices.size(); ++v) {
    const Eigen::Vector3f& p = scene.vertices[v];
    if (std::abs(p.z() + 0.8f) > 0.01f || p.head<2>().norm() >= nearest) continue;
    nearest = static_cast<double>(p.head<2>().norm());
    below = static_cast<std::int64_t>(v);
  }
  const torch::Tensor cosine = transport.directions.select(1, 2).clamp_min(0);
  const torch::Tensor is_blocked =
      (transport.blocker[below] != LightTransport::kOpen).to(torch::kFloat);
  const double share = ((cosine * is_blocked).sum() / cosine.sum()).item<double>();
  const double height = 1.0 - static_cast<double>(kBegin);
  return std::abs(share - 0.25 / (height * height));
}

// Row 61: in a closed room of albedo 0.8 light falls by that at every bounce, and no faster
// or slower.
double LightInAClosedRoomFallsWithItsAlbedo() {
  WorstError worst;
  const Mesh room = MeshOf([](const Eigen::Vector3d& p) { return 0.8 - p.norm(); });
  const auto vertices = static_cast<std::int64_t>(room.vertices.size());
  const LightTransport transport = TraceLight(room, MeshRays(room), 256, kBegin);
  torch::Tensor normal = torch::empty({vertices, 3});
  for (std::int64_t v = 0; v < vertices; ++v) {
    std::copy_n(room.normals[static_cast<std::size_t>(v)].data(), 3,
                normal.data_ptr<float>() + 3 * v);
  }
  constexpr std::int64_t kSome = 256;  // vertices
  const torch::Tensor some = torch::arange(0, vertices, vertices / kSome, torch::kLong);
  const torch::Tensor dark = torch::zeros({256, 3});
  const SurfaceBatch surface{normal.index_select(0, some), normal.index_select(0, some)};
  const MaterialBatch matt{torch::full({some.size(0), 3}, 0.8f), {}, {}};
  double expected = 1;
  torch::Tensor radiance = torch::ones({vertices, 3});
  for (int bounce = 0; bounce < 8; ++bounce) {
    const torch::Tensor out = Shade(surface, matt, LightAt(transport, some, dark, radiance)).Sum();
    expected *= 0.8;
    worst.Add(out.mean().item<double>() / expected - 1);
    radiance = torch::full_like(radiance, out.mean().item<float>());
  }
  return worst.Get();
}

}  // namespace

std::vector<NumericCase> ShadowCases() {
  return {
      {"OneBrightTexelKeepsItsPower", "power, relative", Within(4e-7, 4.5e-8), false,
       OneBrightTexelKeepsItsPower},
      {"AMapTurnedOnceIsTheSame", "radiance", kExact, false, AMapTurnedOnceIsTheSame},
      {"ABlackEnvironmentLeavesBlack", "radiance", kExact, false, ABlackEnvironmentLeavesBlack},
      {"APointWithoutNormalIsNotShaded", "holds", kExact, false, APointWithoutNormalIsNotShaded},
      {"ABallDoesNotShadowItself", "share blocked", kExact, false, ABallDoesNotShadowItself},
      {"ASoftShadowIsAsDeepAsTheSphereIsLarge", "share blocked", Within(0.02, 4.3e-3), false,
       ASoftShadowIsAsDeepAsTheSphereIsLarge},
      {"LightInAClosedRoomFallsWithItsAlbedo", "radiance, relative", Within(1e-3, 1.3e-4), false,
       LightInAClosedRoomFallsWithItsAlbedo},
  };
}

}  // namespace nerf
