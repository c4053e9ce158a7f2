#include "nerf/synthetic/scene.h"

namespace nerf::synthetic {
namespace {

using Eigen::Vector3d;

// Thickness of the slab on which the objects stand; its top is z = 0.
constexpr double kSlab = 0.08;

Object Standing(double x, double y, double radius, const Material& material) {
  return {Sphere{{x, y, radius}, radius}, material};
}

Object Standing(double x, double y, const Vector3d& size, double turn_degrees,
                const Material& material) {
  return {Box{{x, y, size.z() / 2}, size / 2, HeadingFromDegrees(turn_degrees)}, material};
}

Material Slab() {
  Terrazzo terrazzo;
  terrazzo.base = ColorFromSrgbHex(0xd8cbb6);
  terrazzo.chips = {ColorFromSrgbHex(0x6b4a3a), ColorFromSrgbHex(0xf3ece0),
                    ColorFromSrgbHex(0xb5764c), ColorFromSrgbHex(0x55707a)};
  terrazzo.largest = 0.42;
  terrazzo.levels = 2;
  terrazzo.seed = 11;
  return {.albedo = terrazzo};
}

// Without fine detail, which would be smaller than a pixel far away and at grazing angles.
Material Sand() {
  return {.albedo = Marble{.ramp = {ColorFromSrgbHex(0xc4aa7a), ColorFromSrgbHex(0xcfb78a),
                                    ColorFromSrgbHex(0xd8c399), ColorFromSrgbHex(0xe2d0ab)},
                           .frequency = 1.2,
                           .octaves = 4,
                           .seed = 17}};
}

Material BlueMarble() {
  return {.albedo = Marble{.ramp = {ColorFromSrgbHex(0x12304f), ColorFromSrgbHex(0x2f7aa3),
                                    ColorFromSrgbHex(0x9fd0c8), ColorFromSrgbHex(0xf6f1df)},
                           .frequency = 3.0,
                           .octaves = 5,
                           .seed = 23}};
}

Material TowerMosaic() {
  return {.albedo = Mosaic{.palette = {ColorFromSrgbHex(0xd5553a), ColorFromSrgbHex(0xf0b14a),
                                       ColorFromSrgbHex(0xf3e3c3), ColorFromSrgbHex(0x8c2f39)},
                           .mortar = ColorFromSrgbHex(0x3a2c2a),
                           .tile = 0.085,
                           .joint = 0.10,
                           .seed = 37}};
}

Material GreenBlock() {
  return {.albedo = Marble{.ramp = {ColorFromSrgbHex(0x1f3d2b), ColorFromSrgbHex(0x4f8a4c),
                                    ColorFromSrgbHex(0xb7c872), ColorFromSrgbHex(0xf4eed0)},
                           .frequency = 4.5,
                           .octaves = 4,
                           .seed = 41}};
}

Material VioletBall() {
  Terrazzo terrazzo;
  terrazzo.base = ColorFromSrgbHex(0x7d5ba6);
  terrazzo.chips = {ColorFromSrgbHex(0xf7d6e0), ColorFromSrgbHex(0x3b2a5c),
                    ColorFromSrgbHex(0xf2b5a7), ColorFromSrgbHex(0xffffff)};
  terrazzo.largest = 0.12;
  terrazzo.levels = 2;
  terrazzo.seed = 53;
  return {.albedo = terrazzo};
}

Material Gold() {
  return {.albedo = Plain{ColorFromSrgbHex(0xb07a1e)},
          .mirror = Color(0.62, 0.42, 0.16),
          .highlight_exponent = 400};
}

Texture CloudySky() {
  return Sky{.zenith = ColorFromSrgbHex(0x4f8fd0),
             .horizon = ColorFromSrgbHex(0xb9d6ea),
             .cloud = ColorFromSrgbHex(0xf7f3ec),
             .frequency = 2.5,
             .seed = 67};
}

}  // namespace

Scene BuiltInScene() {
  Scene scene;
  scene.objects = {
      {Box{{0, 0, -kSlab / 2}, {1.9, 1.9, kSlab / 2}, HeadingFromDegrees(12)}, Slab()},
      {Disc{{0, 0, -kSlab}, 8}, Sand()},
      Standing(-0.50, 0.38, 0.42, BlueMarble()),
      Standing(0.42, 0.52, {0.34, 0.34, 0.95}, 28, TowerMosaic()),
      Standing(-0.55, -0.50, {0.55, 0.40, 0.30}, -20, GreenBlock()),
      Standing(0.08, -0.85, 0.17, VioletBall()),
      Standing(0.38, -0.25, 0.36, Gold()),
  };
  scene.sun = {.to_light = Vector3d(0.55, -0.45, 0.85).normalized(),
               .irradiance = Color(2.15, 2.0, 1.75)};
  scene.ambient = {.above = Color(0.31, 0.34, 0.39), .below = Color(0.20, 0.19, 0.17)};
  scene.dome = Dome{8, CloudySky()};
  return scene;
}

}  // namespace nerf::synthetic
