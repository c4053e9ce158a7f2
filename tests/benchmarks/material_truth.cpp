#include "tests/benchmarks/material_truth.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "nerf/base/quantile.h"
#include "nerf/base/stopwatch.h"
#include "nerf/image/image_io.h"
#include "nerf/relight/environment_light.h"
#include "nerf/scene/camera.h"
#include "nerf/train/material_fit.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kChunk = 1024;

// Reflection in chunks.
torch::Tensor Reflect(const LightTransport& transport, const torch::Tensor& vertex,
                      const SurfaceBatch& surface, const MaterialBatch& material,
                      const torch::Tensor& light, const torch::Tensor& radiance) {
  std::vector<torch::Tensor> parts;
  for (std::int64_t begin = 0; begin < vertex.size(0); begin += kChunk) {
    const std::int64_t end = std::min(vertex.size(0), begin + kChunk);
    const auto part = [&](const torch::Tensor& all) { return all.slice(0, begin, end); };
    const ReflectedLight out =
        Shade({part(surface.normal), part(surface.to_camera)},
              {part(material.base_color), part(material.roughness), part(material.metallic)},
              LightAt(transport, part(vertex), light, radiance));
    parts.push_back(out.diffuse + out.specular);
  }
  return torch::cat(parts);
}

class Comparison {
 public:
  Comparison(const fs::path& truth, const FoundScene& scene, std::vector<TestView> views)
      : truth_(truth), scene_(scene), views_(std::move(views)) {}

  void Run(const nlohmann::json& lights) {
    const torch::NoGradGuard no_grad;
    for (const TestView& view : views_) found_.push_back(scene_.field.forward(view.position));
    Normals();
    Albedo();
    for (std::size_t i = 0; i < lights.size(); ++i)
      Relit(lights[fmt::format("E{}", i)], static_cast<int>(i));
  }

 private:
  Image Truth(const TestView& view, const std::string& what) const {
    return ReadImage(truth_ / "gt" / (view.name + "_" + what + ".exr"), false);
  }
  torch::Tensor ShadedNormal(std::size_t i) const {
    return ShadingNormals(views_[i].normal, found_[i].normal_offset, scene_.normal_offset);
  }

  void Normals() const {
    double of_surface = 0, shaded = 0, rough = 0, count = 0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const Image truth = Truth(views_[i], "normal"), material = Truth(views_[i], "material");
      const torch::Tensor turned = ShadedNormal(i);
      std::vector<std::int64_t> row_of(truth.pixels.size() / truth.channels, -1);
      for (std::size_t r = 0; r < views_[i].pixels.size(); ++r) row_of[views_[i].pixels[r]] = r;
      for (std::size_t p = 0; p < row_of.size(); ++p) {
        const Eigen::Map<const Eigen::Vector3f> expected(&truth.pixels[truth.channels * p]);
        if (expected.norm() < 0.5f) continue;
        ++count;
        const auto angle = [&](const torch::Tensor& normals) {
          if (row_of[p] < 0) return 90.0;
          const Eigen::Map<const Eigen::Vector3f> n(normals.data_ptr<float>() + 3 * row_of[p]);
          const Eigen::Vector3d in_world = scene_.world_from_normalized * n.cast<double>();
          return std::acos(
                     std::clamp(in_world.dot(expected.cast<double>().normalized()), -1., 1.)) *
                 180 / std::numbers::pi;
        };
        of_surface += angle(views_[i].normal);
        shaded += angle(turned);
        if (row_of[p] >= 0) {
          rough += std::abs(found_[i].material.roughness.data_ptr<float>()[row_of[p]] -
                            material.pixels[material.channels * p]);
        }
      }
    }
    fmt::print("normals {:.2f} degrees, of the surface {:.2f}; roughness off by {:.3f}\n",
               shaded / count, of_surface / count, rough / count);
  }

  // The shown pixels of a view before white, in sRGB, against a picture with alpha.
  double PsnrOf(const TestView& view, const torch::Tensor& linear, const Image& truth) const {
    Image shown(truth.width, truth.height, 3);
    std::ranges::fill(shown.pixels, 1.0f);
    for (std::size_t r = 0; r < view.pixels.size(); ++r) {
      const float opacity = view.opacity.pixels[view.pixels[r]];
      for (int c = 0; c < 3; ++c) {
        const float value = linear.data_ptr<float>()[3 * r + c];
        shown.pixels[3 * view.pixels[r] + c] =
            opacity * SrgbFromLinear(std::clamp(value, 0.0f, 1.0f)) + 1 - opacity;
      }
    }
    double error = 0;
    const bool is_linear = truth.encoding == ColorEncoding::kLinear;
    for (std::size_t p = 0; p < truth.pixels.size() / truth.channels; ++p) {
      const float* const pixel = &truth.pixels[truth.channels * p];
      for (int c = 0; c < 3; ++c) {
        const float value = is_linear ? SrgbFromLinear(std::clamp(pixel[c], 0.0f, 1.0f)) : pixel[c];
        const float d = shown.pixels[3 * p + c] - (pixel[3] * value + 1 - pixel[3]);
        error += static_cast<double>(d * d);
      }
    }
    return -10 * std::log10(error / static_cast<double>(shown.pixels.size()));
  }

  torch::Tensor AlbedoOf(const MaterialBatch& material) const {
    return material.base_color * (1 - material.metallic.unsqueeze(1));
  }

  void Albedo() {
    std::array<std::vector<double>, 3> ratios;
    std::vector<Image> truths;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      truths.push_back(Truth(views_[i], "albedo"));
      const torch::Tensor albedo = AlbedoOf(found_[i].material).contiguous();
      for (std::size_t r = 0; r < views_[i].pixels.size(); ++r) {
        const float* const truth = &truths[i].pixels[4 * views_[i].pixels[r]];
        for (int c = 0; c < 3; ++c) {
          const float found = albedo.data_ptr<float>()[3 * r + c];
          if (truth[3] > 0.999f && truth[c] > 1e-3f && found > 1e-3f) {
            ratios[c].push_back(static_cast<double>(truth[c] / found));
          }
        }
      }
    }
    std::vector<float> scale;
    for (auto& of_channel : ratios) scale.push_back(static_cast<float>(Median(of_channel)));
    scale_ = torch::tensor(scale);
    double psnr = 0, unscaled = 0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const torch::Tensor albedo = AlbedoOf(found_[i].material);
      psnr += PsnrOf(views_[i], (albedo * scale_).contiguous(), truths[i]);
      unscaled += PsnrOf(views_[i], albedo.contiguous(), truths[i]);
    }
    fmt::print("albedo {:.2f} dB, scaled by {:.3f} {:.3f} {:.3f}; as it is {:.2f} dB\n",
               psnr / views_.size(), scale[0], scale[1], scale[2], unscaled / views_.size());
  }

  MaterialBatch Scaled(const MaterialBatch& material) const {
    return {(material.base_color * scale_).clamp(0, 1), material.roughness, material.metallic};
  }

  // [V,3] what the vertices reflect, after some bounces.
  torch::Tensor Vertices(const torch::Tensor& light, int bounces) {
    const auto count = static_cast<std::int64_t>(scene_.surface.mesh.vertices.size());
    torch::Tensor position = torch::empty({count, 3}), normal = torch::empty({count, 3});
    for (std::int64_t v = 0; v < count; ++v) {
      std::copy_n(scene_.surface.mesh.vertices[v].data(), 3, position.data_ptr<float>() + 3 * v);
      std::copy_n(scene_.surface.mesh.normals[v].data(), 3, normal.data_ptr<float>() + 3 * v);
    }
    const MaterialBatch material = Scaled(scene_.field.forward(position).material);
    torch::Tensor radiance = torch::zeros({count, 3});
    for (int bounce = 0; bounce < bounces; ++bounce) {
      radiance = Reflect(scene_.transport, torch::arange(count, torch::kLong), {normal, normal},
                         material, light, radiance);
    }
    return radiance;
  }

  void Relit(const nlohmann::json& light, int index) {
    const Stopwatch watch;
    const EnvironmentMap map =
        EnvironmentMap::Read(truth_.parent_path() / "environments" / light["file"]);
    const torch::Tensor radiance = RadianceFrom(map, scene_.transport.directions,
                                                MapFromZUpWorld() * scene_.world_from_normalized) *
                                   light["png_exposure"].get<float>();
    const torch::Tensor vertices = Vertices(radiance, 2);
    const double prepared = watch.Seconds();
    double psnr = 0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const torch::Tensor shown =
          Reflect(scene_.transport, views_[i].vertex, {ShadedNormal(i), views_[i].to_camera},
                  Scaled(found_[i].material), radiance, vertices);
      const std::string name = views_[i].name + (index > 0 ? fmt::format("_E{}", index) : "");
      psnr += PsnrOf(views_[i], shown.contiguous(),
                     ReadImage(truth_ / "test" / (name + ".png"), false));
    }
    fmt::print("E{} relit {:.2f} dB; map and bounces {:.1f} s, a view {:.2f} s\n", index,
               psnr / views_.size(), prepared, (watch.Seconds() - prepared) / views_.size());
    std::fflush(stdout);
  }

  const fs::path& truth_;
  const FoundScene& scene_;
  std::vector<TestView> views_;
  std::vector<SurfaceProperties> found_;
  torch::Tensor scale_;
};

}  // namespace

TestView LookFrom(const SceneModel& model, const ExtractedSurface& surface, const MeshRays& rays,
                  const PosedImage& image, const Camera& camera) {
  const Eigen::Isometry3d frame =
      model.Scene().normalized_from_world.NormalizedFromCamera(image.world_from_camera);
  RenderedView rendered = model.Render({camera, image.world_from_camera});
  TestView view{fs::path(image.name).stem().string(),
                camera,
                std::move(rendered.opacity),
                {},
                {},
                {},
                {},
                {}};
  std::vector<float> position, normal, to_camera;
  std::vector<std::int64_t> vertex;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      if (*view.opacity.At(x, y) < 0.02f) continue;
      const Eigen::Vector3d ray = frame.linear() * *DirectionFromPixel(camera, {x + 0.5, y + 0.5});
      const Eigen::Vector3d at =
          frame.translation() + static_cast<double>(*rendered.depth.At(x, y)) * ray;
      const Eigen::Vector3d outwards = surface.distance.Gradient(at).stableNormalized();
      // The nearest vertex: below the point, or where the ray meets the mesh.
      const auto offset = static_cast<float>(3 * surface.distance.cell);
      auto hit = rays.FirstHit(at.cast<float>() + offset * outwards.cast<float>(),
                               -outwards.cast<float>());
      if (!hit || hit->distance > 3 * offset) {
        hit = rays.FirstHit(frame.translation().cast<float>(), ray.cast<float>());
      }
      if (!hit) continue;
      view.pixels.push_back(static_cast<std::int64_t>(y) * camera.width + x);
      vertex.push_back(NearestVertex(surface.mesh, *hit));
      for (int k = 0; k < 3; ++k) {
        position.push_back(static_cast<float>(at[k]));
        normal.push_back(static_cast<float>(outwards[k]));
        to_camera.push_back(static_cast<float>(-ray[k]));
      }
    }
  }
  const auto rows = [](const std::vector<float>& values) {
    return torch::tensor(values).view({-1, 3});
  };
  view.position = rows(position);
  view.normal = rows(normal);
  view.to_camera = rows(to_camera);
  view.vertex = torch::tensor(vertex, torch::kLong);
  return view;
}

void CompareWithTruth(const fs::path& truth, const FoundScene& found, std::vector<TestView> views) {
  const nlohmann::json test = nlohmann::json::parse(std::ifstream(truth / "transforms_test.json"));
  Comparison(truth, found, std::move(views)).Run(test["lights"]);
}

}  // namespace nerf
