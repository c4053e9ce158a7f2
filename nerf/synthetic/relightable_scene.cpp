#include "nerf/synthetic/relightable_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "nerf/material/metallic_roughness.h"
#include "nerf/synthetic/texture.h"

namespace nerf::synthetic {
namespace {

using Eigen::Vector3d;

std::shared_ptr<const Brdf> BrdfOf(const TrueMaterial& material) {
  return std::make_shared<MetallicRoughness>(material.base_color, material.roughness,
                                             material.metallic);
}

void AddPlain(RelightableScene& scene, Shape shape, const TrueMaterial& material) {
  scene.scene.surfaces.push_back({std::move(shape), BrdfOf(material)});
  scene.materials.push_back({material});
}

void AddPattern(RelightableScene& scene, Shape shape, std::vector<TrueMaterial> materials,
                std::function<std::size_t(const Vector3d&)> index) {
  auto pattern = std::make_shared<BrdfPattern>();
  for (const TrueMaterial& material : materials) pattern->brdfs.push_back(BrdfOf(material));
  pattern->index = std::move(index);
  Surface surface{std::move(shape)};
  surface.pattern = std::move(pattern);
  scene.scene.surfaces.push_back(std::move(surface));
  scene.materials.push_back(std::move(materials));
}

std::size_t Checker(const Vector3d& x, double side) {
  const auto cell = [&](double value) { return static_cast<int>(std::floor(value / side + 1e-9)); };
  return static_cast<std::size_t>((cell(x.x()) + cell(x.y())) & 1);
}

// 1 in the direction, falling smoothly to 0 at this angle from it.
double Glow(const Vector3d& direction, const Vector3d& towards, double degrees) {
  const double edge = std::cos(degrees * 3.14159265358979 / 180);
  const double cosine = direction.dot(towards.normalized());
  const double t = std::clamp((cosine - edge) / (1 - edge), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// The value of each pixel of a map, by its direction in the axes of EnvironmentMap.
Image Rasterize(int height, const std::function<Color(const Vector3d&)>& radiance) {
  Image image(2 * height, height, 3, ColorEncoding::kLinear);
  const EnvironmentMap axes(image, "");
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < 2 * height; ++x) {
      const Color color = radiance(axes.Direction(x, y));
      for (int c = 0; c < 3; ++c) image.At(x, y)[c] = static_cast<float>(color[c]);
    }
  }
  return image;
}

}  // namespace

const TrueMaterial& RelightableScene::MaterialAt(const SurfaceHit& hit) const {
  const auto surface = static_cast<std::size_t>(hit.item - scene.surfaces.data());
  const auto& own = materials.at(surface);
  if (!hit.item->pattern) return own.front();
  return own.at(hit.item->pattern->index(ShapeFromWorld(hit.item->shape, hit.x_in_world)));
}

RelightableScene MakeRelightableScene() {
  RelightableScene scene;
  AddPattern(scene, Box{{0, 0, -0.06}, {0.85, 0.85, 0.06}},
             {{Color(0.62, 0.55, 0.42), 0.6, 0}, {Color(0.12, 0.25, 0.35), 0.6, 0}},
             [](const Vector3d& x) { return Checker(x, 0.2125); });
  AddPattern(scene, Sphere{{-0.38, 0.32, 0.3}, 0.3},
             {{Color(0.65, 0.20, 0.10), 0.8, 0}, {Color(0.75, 0.70, 0.60), 0.8, 0}},
             [](const Vector3d& x) {
               return static_cast<std::size_t>(FractalNoise(5 * x, 2, 7) > 0 ? 1 : 0);
             });
  AddPlain(scene, Sphere{{0.40, 0.38, 0.24}, 0.24}, {Color(0.95, 0.72, 0.38), 0.3, 1});
  AddPlain(scene, Sphere{{0.42, -0.40, 0.2}, 0.2}, {Color(0.06, 0.12, 0.45), 0.2, 0});
  AddPlain(scene, Box{{-0.42, -0.42, 0.25}, {0.16, 0.16, 0.25}, HeadingFromDegrees(25)},
           {Color(0.12, 0.42, 0.15), 0.9, 0});
  AddPlain(scene, Box{{0, 0, 0.36}, {0.035, 0.42, 0.36}, HeadingFromDegrees(-40)},
           {Color(0.78, 0.78, 0.78), 0.7, 0});
  return scene;
}

std::vector<BuiltInLight> BuiltInLights() {
  const Vector3d sun(0.8, 0.5, 0.45), key(-0.3, -0.9, 0.6), fill(0.9, -0.2, 0.2);
  return {
      {"sunny",
       [=](const Vector3d& d) -> Color {
         const double up = std::max(0.0, d.z());
         const Color sky =
             d.z() > 0 ? Color(0.55 - 0.3 * up, 0.65 - 0.2 * up, 0.85) : Color(0.22, 0.20, 0.17);
         return sky + 14 * Glow(d, sun, 14) * Color(1, 0.85, 0.6);
       }},
      {"lamps",
       [=](const Vector3d& d) -> Color {
         return Color(0.06, 0.06, 0.07) + 9 * Glow(d, key, 22) * Color(1, 0.97, 0.9) +
                2.5 * Glow(d, fill, 35) * Color(0.6, 0.75, 1);
       }},
      {"overcast",
       [](const Vector3d& d) -> Color {
         return (0.35 + 0.75 * std::max(0.0, d.z())) * Color(0.9, 0.97, 1.05);
       }},
  };
}

EnvironmentMap MapInWorld(const BuiltInLight& light, int height) {
  return {Rasterize(height, light.radiance), light.name};
}

Image MapInFile(const BuiltInLight& light, int height) {
  return Rasterize(height, [&](const Vector3d& d) {
    // The inverse of MapFromZUpWorld: the centre of the map, -z there, is +x.
    return light.radiance(Vector3d(-d.z(), -d.x(), d.y()));
  });
}

}  // namespace nerf::synthetic
