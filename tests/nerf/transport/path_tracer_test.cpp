#include "nerf/transport/path_tracer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "nerf/base/parallel.h"
#include "nerf/material/coated_diffuse.h"
#include "nerf/material/lambert.h"
#include "nerf/scene/camera.h"
#include "nerf/transport/scene_renderer.h"
#include "tests/support/input_error_of.h"

namespace nerf {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

using std::numbers::pi;

Surface DiffuseSphere(const Color& albedo, const Vector3d& center = Vector3d::Zero()) {
  return {Sphere{center, 1}, std::make_shared<Lambert>(albedo)};
}

// The mean radiance of many paths, and their mean number of rays.
struct Mean {
  Color radiance = Color::Zero();
  double rays = 0;
};
Mean MeanRadiance(const SurfaceScene& scene, const TransportTerms& terms, const Ray& ray,
                  int paths) {
  const PathTracer tracer(scene, terms);
  Mean mean;
  std::int64_t rays = 0;
  for (int i = 0; i < paths; ++i) {
    UniformStream random(1, 0, static_cast<std::uint64_t>(i));
    mean.radiance += tracer.Radiance(ray, random, rays);
  }
  mean.radiance /= paths;
  mean.rays = static_cast<double>(rays) / paths;
  return mean;
}

Ray Down(double x, double y) { return {{x, y, 10}, -Vector3d::UnitZ()}; }

TEST(PathTracer, MatchesTheClosedFormOfASphereUnderADirectionalLight) {
  SurfaceScene scene;
  const Color albedo(0.8, 0.5, 0.25);
  scene.surfaces = {DiffuseSphere(albedo)};
  const Vector3d to_light(std::sqrt(0.75), 0, 0.5);
  scene.directional_lights = {{to_light, Color(3, 2, 1)}};
  for (const double x : {-0.9, -0.4, 0.0, 0.3, 0.8}) {
    const Vector3d normal(x, 0, std::sqrt(1 - x * x));
    const Color expected = albedo / pi * Color(3, 2, 1) * std::max(0.0, normal.dot(to_light));
    const Color found = MeanRadiance(scene, {}, Down(x, 0), 1).radiance;
    EXPECT_LT((found - expected).abs().maxCoeff(), 1e-12) << x;
  }
}

TEST(PathTracer, PointLightsFallOffWithTheSquareOfTheDistance) {
  SurfaceScene scene;
  scene.surfaces = {DiffuseSphere(Color::Ones())};
  scene.point_lights = {{{0, 0, 3}, Color::Constant(8)}};
  EXPECT_NEAR(MeanRadiance(scene, {}, {{0, 0.001, 10}, -Vector3d::UnitZ()}, 1).radiance.x(),
              8.0 / 4 / pi, 1e-3);
}

// A body that absorbs nothing is invisible under uniform illumination (white furnace test).
TEST(PathTracer, AWhiteConvexBodyIsInvisibleInAFurnace) {
  SurfaceScene scene;
  scene.environment = std::make_shared<EnvironmentMap>(EnvironmentMap::Uniform(Color::Ones()));
  for (const auto& brdf : std::vector<std::shared_ptr<const Brdf>>{
           std::make_shared<Lambert>(Color::Ones()),
           std::make_shared<CoatedDiffuse>(Color::Ones(), 1.5, 0.3)}) {
    scene.surfaces = {{Sphere{}, brdf}};
    for (const double x : {0.0, 0.5, 0.9}) {
      const double found = MeanRadiance(scene, {}, Down(x, 0), 20000).radiance.x();
      EXPECT_NEAR(found, 1, 0.02) << x;
    }
  }
}

// Two white spheres side by side are invisible in a furnace only with all bounces between them.
TEST(PathTracer, AllBouncesTogetherMakeConcaveWhiteBodiesInvisibleInAFurnace) {
  SurfaceScene scene;
  scene.surfaces = {DiffuseSphere(Color::Ones(), {-1.0, 0, 0}),
                    DiffuseSphere(Color::Ones(), {1.0, 0, 0})};
  scene.environment = std::make_shared<EnvironmentMap>(EnvironmentMap::Uniform(Color::Ones()));
  double before = 0;
  for (const int bounces : {0, 1, 3, 30}) {
    TransportTerms terms;
    terms.bounces = bounces;
    const double found = MeanRadiance(scene, terms, Down(0.15, 0), 20000).radiance.x();
    EXPECT_GT(found, before - 0.01);
    before = found;
    if (bounces == 0) {
      EXPECT_LT(found, 0.8);
    }
    if (bounces == 30) {
      EXPECT_NEAR(found, 1, 0.02);
    }
  }
}

// Inside a closed glowing sphere of albedo a the radiance is L_e (1 + a + a^2 + ...).
TEST(PathTracer, BouncesInsideAGlowingSphereAreAGeometricSeries) {
  SurfaceScene scene;
  constexpr double kAlbedo = 0.6;
  scene.surfaces = {DiffuseSphere(Color::Constant(kAlbedo))};
  scene.surfaces[0].emission = Color::Constant(0.5);
  const Ray ray{{0.2, 0.1, 0}, Vector3d(0.6, 0, 0.8)};
  for (const int bounces : {0, 1, 2, 60}) {
    TransportTerms terms;
    terms.bounces = bounces;
    const double expected = 0.5 * (1 - std::pow(kAlbedo, bounces + 2)) / (1 - kAlbedo);
    EXPECT_NEAR(MeanRadiance(scene, terms, ray, 1).radiance.x(), expected, 1e-9) << bounces;
  }
}

// The radiosity integrated over a diffuse sphere is the albedo times the power through its cross
// section.
TEST(PathTracer, ASphereReflectsItsAlbedoTimesTheIncomingPower) {
  SurfaceScene scene;
  scene.surfaces = {DiffuseSphere(Color::Constant(0.7))};
  scene.directional_lights = {{Vector3d::UnitZ(), Color::Constant(2)}};
  double power = 0;
  constexpr int kPoints = 4000;
  for (int i = 0; i < kPoints; ++i) {
    const double z = -1 + 2 * (i + 0.5) / kPoints;
    const Vector3d n(std::sqrt(1 - z * z), 0, z);
    power += pi * MeanRadiance(scene, {}, {3 * n, -n}, 1).radiance.x() * 4 * pi / kPoints;
  }
  EXPECT_NEAR(power, 0.7 * 2 * pi, 0.01);
}

TEST(PathTracer, CastsShadowsUnlessTheyAreDisabled) {
  SurfaceScene scene;
  scene.surfaces = {DiffuseSphere(Color::Ones()), DiffuseSphere(Color::Ones(), {0, 0, 3})};
  scene.directional_lights = {{Vector3d::UnitZ()}};
  const Ray from_the_side{{5, 0, 0.5}, Vector3d(-1, 0, 0)};
  TransportTerms terms;
  terms.bounces = 0;
  EXPECT_TRUE(MeanRadiance(scene, terms, from_the_side, 1).radiance.isZero());
  terms.shadows = false;
  EXPECT_NEAR(MeanRadiance(scene, terms, from_the_side, 1).radiance.x(), 0.5, 1e-9);
}

TEST(PathTracer, DisabledTermsCostNoRays) {
  SurfaceScene scene;
  scene.surfaces = {DiffuseSphere(Color::Constant(0.5)),
                    DiffuseSphere(Color::Constant(0.5), {2.0, 0, 0})};
  scene.directional_lights = {{Vector3d::UnitZ()}, {Vector3d(0.1, 0, 1).normalized()}};
  TransportTerms terms{.emission = true, .direct = false, .shadows = true, .bounces = 9};
  EXPECT_EQ(MeanRadiance(scene, terms, Down(0, 0), 10).rays, 1);
  terms = {.emission = true, .direct = true, .shadows = false, .bounces = 0};
  EXPECT_EQ(MeanRadiance(scene, terms, Down(0, 0), 10).rays, 1);
  terms.shadows = true;
  EXPECT_EQ(MeanRadiance(scene, terms, Down(0, 0), 10).rays, 3);
  terms.bounces = 1;
  EXPECT_GT(MeanRadiance(scene, terms, Down(0, 0), 10).rays, 3);
}

// With shadows the environment is sampled by luminance and by BRDF; both against the closed form.
TEST(PathTracer, ADiffuseSphereShowsTheIrradianceOfTheEnvironment) {
  Image image(64, 32, 3, ColorEncoding::kLinear);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = 0.2f;
  for (int c = 0; c < 3; ++c) image.At(40, 9)[c] = 200;
  auto map = std::make_shared<EnvironmentMap>(image, "sun");
  SurfaceScene scene;
  scene.environment = map;
  scene.surfaces = {DiffuseSphere(Color::Constant(0.5))};
  for (const double x : {-0.5, 0.0, 0.5}) {
    const Vector3d normal(x, 0, std::sqrt(1 - x * x));
    const double expected = 0.5 / pi * map->Irradiance(normal).x();
    for (const bool shadows : {true, false}) {
      TransportTerms terms;
      terms.shadows = shadows;
      const double found = MeanRadiance(scene, terms, Down(x, 0), 20000).radiance.x();
      EXPECT_NEAR(found, expected, 0.03 * expected) << x << " " << shadows;
    }
  }
}

TEST(PathTracer, RefusesBouncesOutOfRange) {
  TransportTerms terms;
  terms.bounces = -1;
  const SurfaceScene scene;
  EXPECT_THAT(test::InputErrorOf([&] { PathTracer(scene, terms); }), HasSubstr("--bounces"));
}

TEST(SubsurfaceSphere, LightReachesBeyondTheTerminator) {
  SurfaceScene scene;
  const Sphere sphere{{0, 0, 0}, 1};
  Surface ball{sphere, nullptr};
  ball.subsurface = std::make_shared<SubsurfaceSphere>(sphere, InUnits(MarbleMedium(), 0.2));
  scene.surfaces = {ball};
  scene.directional_lights = {{Vector3d::UnitX()}};
  const double lit = MeanRadiance(scene, {}, Down(0.5, 0), 1).radiance.x();
  const double dusk = MeanRadiance(scene, {}, Down(-0.1, 0), 1).radiance.x();
  const double night = MeanRadiance(scene, {}, Down(-0.9, 0), 1).radiance.x();
  EXPECT_GT(dusk, 0.05 * lit);
  EXPECT_GT(lit, dusk);
  EXPECT_GT(dusk, night);
  EXPECT_GT(night, 0);
}

TEST(SceneRenderer, EstimatesItsNoiseAndStopsAtTheRequestedOne) {
  SurfaceScene scene;
  scene.surfaces = {DiffuseSphere(Color::Constant(0.5)),
                    DiffuseSphere(Color::Constant(0.5), {1.5, 0, 0})};
  Image image(64, 32, 3, ColorEncoding::kLinear);
  std::ranges::fill(image.pixels, 1.0f);
  scene.environment = std::make_shared<EnvironmentMap>(image, "white");
  const Camera camera = PinholeFromFov(16, 12, 0.5);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Vector3d(0, 0, -8);
  RenderSettings settings;
  settings.positions = 1;
  settings.paths_per_position = 64;
  const SceneRendering few = RenderScene(scene, {}, camera, pose, settings);
  settings.paths_per_position = 1024;
  settings.seed = 1;
  const SceneRendering many = RenderScene(scene, {}, camera, pose, settings);
  EXPECT_NEAR(few.noise / many.noise, 4, 0.8);
  // The estimated noise agrees with the difference of the pictures.
  double squares = 0;
  double sum = 0;
  for (std::size_t i = 0; i < few.color.pixels.size(); ++i) {
    squares += std::pow(few.color.pixels[i] - many.color.pixels[i], 2);
    sum += many.color.pixels[i];
  }
  const auto count = static_cast<double>(few.color.pixels.size());
  EXPECT_NEAR(std::sqrt(squares / count) / (sum / count) / few.noise, 1.03, 0.25);
  settings.stop_at_noise = 1.5 * few.noise;
  EXPECT_LT(RenderScene(scene, {}, camera, pose, settings).rays, many.rays / 8);
}

TEST(SceneRenderer, IsIndependentOfTheNumberOfThreadsAndCanBeStopped) {
  SurfaceScene scene;
  scene.surfaces = {DiffuseSphere(Color::Constant(0.5))};
  scene.environment = std::make_shared<EnvironmentMap>(EnvironmentMap::Uniform(Color::Ones()));
  const Camera camera = PinholeFromFov(8, 6, 0.5);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Vector3d(0, 0, -5);
  RenderSettings settings;
  settings.paths_per_position = 4;
  const int threads = NumThreads();
  SetNumThreads(1);
  const Image one = RenderScene(scene, {}, camera, pose, settings).color;
  SetNumThreads(3);
  EXPECT_EQ(RenderScene(scene, {}, camera, pose, settings).color.pixels, one.pixels);
  SetNumThreads(threads);
  const auto stopped = RenderScene(scene, {}, camera, pose, settings, "", [] { return false; });
  EXPECT_FALSE(stopped.finished);
  settings.positions = 0;
  EXPECT_THAT(test::InputErrorOf([&] { RenderScene(scene, {}, camera, pose, settings); }),
              HasSubstr("positions"));
}

}  // namespace
}  // namespace nerf
