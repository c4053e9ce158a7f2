#include "nerf/synthetic/ray_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace nerf::synthetic {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

void ExpectColor(const Color& actual, const Color& expected, double tolerance = 1e-12) {
  EXPECT_LT((actual - expected).matrix().norm(), tolerance)
      << actual.transpose() << " instead of " << expected.transpose();
}

const Color kAlbedo(0.8, 0.5, 0.25);

// A diffuse sphere at the origin, with the sun 60 degrees off the zenith, towards +x.
Scene DiffuseSphere() {
  Scene scene;
  scene.objects = {{Sphere{Vector3d::Zero(), 1}, {.albedo = Plain{kAlbedo}}}};
  scene.sun = {Vector3d(std::sqrt(0.75), 0, 0.5), Color(3, 2, 1)};
  return scene;
}

Ray Down(double x, double y) { return {{x, y, 10}, -Vector3d::UnitZ()}; }

TEST(Radiance, MatchesTheClosedFormOfALambertianSphere) {
  const Scene scene = DiffuseSphere();
  for (const double x : {0.0, 0.3, 0.8}) {
    const Vector3d normal(x, 0, std::sqrt(1 - x * x));
    const double cosine = normal.dot(scene.sun.to_light);
    ExpectColor(Radiance(scene, Down(x, 0), 0), kAlbedo * scene.sun.irradiance * (cosine / kPi));
  }
}

TEST(Radiance, IsAmbientAloneOnTheSideThatFacesAway) {
  Scene scene = DiffuseSphere();
  scene.ambient = {Color(0.4, 0.4, 0.4), Color(0.1, 0.1, 0.1)};
  const double x = -0.8;  // the normal there is (-0.8, 0, 0.6): cosine with the sun < 0
  const double up = 0.5 + 0.5 * 0.6;
  ExpectColor(Radiance(scene, Down(x, 0), 0), kAlbedo * (0.1 + 0.3 * up));
}

TEST(Radiance, OfAWhiteSurfaceIsTheUniformAmbient) {
  Scene scene;
  scene.objects = {{Sphere{Vector3d::Zero(), 1}, {.albedo = Plain{Color::Ones()}}}};
  scene.ambient = {Color(0.3, 0.6, 0.9), Color(0.3, 0.6, 0.9)};
  for (const double x : {-0.9, 0.0, 0.5}) {
    ExpectColor(Radiance(scene, Down(x, 0.1), 0), Color(0.3, 0.6, 0.9));
  }
}

TEST(Radiance, IsAmbientAloneInShadow) {
  Scene scene = DiffuseSphere();
  scene.ambient = {Color(0.2, 0.2, 0.2), Color(0.2, 0.2, 0.2)};
  scene.objects.push_back({Disc{{0, 0, -1}, 10}, {.albedo = Plain{kAlbedo}}});
  // The sun is over +x, so that the centre of the shadow is at x = -1 / tan(30 degrees).
  const double middle = -std::sqrt(3.0);
  ExpectColor(Radiance(scene, Down(middle, 0), 0), kAlbedo * 0.2);
  const Color lit = Radiance(scene, Down(middle, 1.01), 0);  // the shadow is 2 wide there
  ExpectColor(lit, kAlbedo * 0.2 + kAlbedo * scene.sun.irradiance * (0.5 / kPi));
  ExpectColor(Radiance(scene, Down(middle, 0.99), 0), kAlbedo * 0.2);
}

TEST(Radiance, OfTheDomeIsItsTexture) {
  Scene scene = DiffuseSphere();
  const Color before = Radiance(scene, Down(0.3, 0), 0);
  scene.dome = Dome{20, Plain{Color(0.1, 0.2, 0.3)}};
  ExpectColor(Radiance(scene, {{0, 0, 10}, Vector3d::UnitZ()}, 0), Color(0.1, 0.2, 0.3));
  ExpectColor(Radiance(scene, Down(0.3, 0), 0), before);
}

TEST(Radiance, IsBlackIfNothingIsHit) {
  ExpectColor(Radiance(DiffuseSphere(), {{0, 0, 10}, Vector3d::UnitZ()}, 2), Color::Zero());
}

// A mirror under a uniform dome reflects the same radiance in all directions.
Scene MirrorUnderDome(const Color& reflectance) {
  Scene scene;
  scene.objects = {
      {Sphere{Vector3d::Zero(), 1}, {.albedo = Plain{Color::Zero()}, .mirror = reflectance}}};
  scene.dome = Dome{20, Plain{Color(0.5, 0.5, 0.5)}};
  return scene;
}

TEST(Radiance, OfAMirrorAtNormalIncidenceIsScaledByItsReflectance) {
  const Color reflectance(0.9, 0.6, 0.3);
  const Scene scene = MirrorUnderDome(reflectance);
  ExpectColor(Radiance(scene, Down(0, 0), 1), reflectance * 0.5);
  ExpectColor(Radiance(scene, Down(0, 0), 0), Color::Zero());
}

TEST(Radiance, OfAMirrorFollowsSchlick) {
  const Color reflectance(0.5, 0.5, 0.5);
  const Scene scene = MirrorUnderDome(reflectance);
  const double cosine = 0.6;
  const double F = 0.5 + 0.5 * std::pow(1 - cosine, 5);
  ExpectColor(Radiance(scene, Down(0.8, 0), 1), Color::Constant(F * 0.5));
}

TEST(Radiance, OfAPerfectMirrorIsThatOfTheReflectedObject) {
  Scene scene = MirrorUnderDome(Color::Ones());
  // At 45 degrees to the normal, the sphere reflects the ray towards +x.
  scene.objects.push_back({Box{{5, 0, 0.7}, {1, 1, 1}}, {.albedo = Plain{Color(0.2, 0.4, 0.6)}}});
  scene.ambient = {Color::Ones(), Color::Ones()};
  ExpectColor(Radiance(scene, Down(std::numbers::sqrt2 / 2, 0), 1), Color(0.2, 0.4, 0.6), 1e-9);
}

TEST(Radiance, OfACoatedWhiteSurfaceInAFurnaceIsThatOfTheFurnace) {
  Scene scene = MirrorUnderDome(Color(0.4, 0.6, 0.8));
  scene.objects.front().material.albedo = Plain{Color::Ones()};
  scene.ambient = {Color::Constant(0.5), Color::Constant(0.5)};
  for (const double x : {0.0, 0.5, 0.9, 0.999}) {
    ExpectColor(Radiance(scene, Down(x, 0), 1), Color::Constant(0.5));
  }
}

TEST(Radiance, OfTwoFacingMirrorsTerminates) {
  Scene scene = MirrorUnderDome(Color::Ones());
  scene.objects.push_back({Disc{{0, 0, -1.5}, 10}, {.albedo = Plain{}, .mirror = Color::Ones()}});
  const Color radiance = Radiance(scene, {{0, 0, -1.25}, -Vector3d::UnitZ()}, 50);
  ExpectColor(radiance, Color::Zero());
}

TEST(Radiance, HasAHighlightOfTheSunOnMirrors) {
  Scene scene = MirrorUnderDome(Color::Constant(0.5));
  scene.dome.reset();
  scene.sun = {Vector3d::UnitZ(), Color::Ones()};
  const double n = scene.objects.front().material.highlight_exponent;
  ExpectColor(Radiance(scene, Down(0, 0), 0), Color::Constant(0.5 * (n + 2) / (2 * kPi)));
  EXPECT_LT(Radiance(scene, Down(0.5, 0), 0).maxCoeff(), 1e-6);
}

// The sun in the zenith over a glossy sphere, under a bright dome that gloss must not reflect.
Scene GlossInTheSun(double gloss, double exponent) {
  Scene scene = MirrorUnderDome(Color::Zero());
  scene.dome = Dome{20, Plain{Color::Constant(100)}};
  scene.objects.front().material.gloss = Color::Constant(gloss);
  scene.objects.front().material.highlight_exponent = exponent;
  scene.sun = {Vector3d::UnitZ(), Color::Ones()};
  return scene;
}

TEST(Radiance, OfGlossHasABroadHighlightOfTheSunOnly) {
  const Scene scene = GlossInTheSun(0.3, 10);
  const double peak = 0.3 * 12 / (2 * kPi);
  ExpectColor(Radiance(scene, Down(0, 0), 2), Color::Constant(peak));
  // At 10 degrees to the normal the ray is reflected 20 degrees off the sun.
  const double angle = kPi / 18;
  ExpectColor(Radiance(scene, Down(std::sin(angle), 0), 2),
              Color::Constant(peak * std::pow(std::cos(2 * angle), 10) * std::cos(angle)));
}

TEST(Radiance, OfGlossConservesEnergy) {
  Scene scene = GlossInTheSun(0.3, 10);
  scene.objects.front().material.albedo = Plain{kAlbedo};
  scene.sun.irradiance = Color::Zero();
  scene.ambient = {Color::Ones(), Color::Ones()};
  ExpectColor(Radiance(scene, Down(0, 0), 2), 0.7 * kAlbedo);
}

TEST(Trace, NormalsFaceTheRay) {
  const Scene scene = DiffuseSphere();
  const auto outside = Trace(scene, Down(0, 0));
  const auto inside = Trace(scene, {Vector3d::Zero(), Vector3d::UnitZ()});
  ASSERT_TRUE(outside && inside);
  EXPECT_LT((outside->normal_in_world - Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((inside->normal_in_world + Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(Trace, FindsTheNearestObjectInAnyOrder) {
  Scene scene = DiffuseSphere();
  scene.objects.insert(scene.objects.begin(), {Disc{{0, 0, -1}, 10}, {.albedo = Plain{}}});
  scene.objects.push_back({Disc{{0, 0, 3}, 0.5}, {.albedo = Plain{}}});
  EXPECT_NEAR(Trace(scene, Down(0, 0))->distance, 7, 1e-12);
  EXPECT_NEAR(Trace(scene, Down(0.7, 0))->distance, 10 - std::sqrt(0.51), 1e-12);
  EXPECT_NEAR(Trace(scene, Down(2, 0))->distance, 11, 1e-12);
}

TEST(BuiltInScene, EveryRayFromInsideHitsASurface) {
  const Scene scene = BuiltInScene();
  for (int i = 0; i < 500; ++i) {
    const double z = -1 + 2 * (i + 0.5) / 500;
    const double angle = 2.399963 * i;
    const double r = std::sqrt(1 - z * z);
    const auto hit = Trace(scene, {{0, 0, 2}, {r * std::cos(angle), r * std::sin(angle), z}});
    ASSERT_TRUE(hit.has_value());
    EXPECT_LE(hit->distance, 10);
  }
}

}  // namespace
}  // namespace nerf::synthetic
