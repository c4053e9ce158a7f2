#include "nerf/commands/relit_pictures.h"

#include <algorithm>
#include <cmath>

#include "nerf/capture/relight.h"
#include "nerf/image/image_io.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

// The radiance of a map behind every pixel, [P,3] by pixel.
std::vector<Eigen::Vector3f> Behind(const DepthMap& depth, const RelitBackground& background) {
  std::vector<Eigen::Vector3f> radiance(depth.opacity.pixels.size(), Eigen::Vector3f::Zero());
  for (std::size_t p = 0; p < radiance.size(); ++p) {
    const auto x = static_cast<double>(p % static_cast<std::size_t>(depth.camera.width));
    const auto y = static_cast<double>(p / static_cast<std::size_t>(depth.camera.width));
    const auto direction = DirectionFromPixel(depth.camera, {x + 0.5, y + 0.5});
    if (!direction) continue;
    const Eigen::Vector3d in_map =
        background.map_from_frame * depth.grid_from_camera.linear() * *direction;
    radiance[p] = background.gain * background.map->Radiance(in_map).matrix().cast<float>();
  }
  return radiance;
}

// [P, C] of seen pixels as an image with opacity in channel 3; C is 1 or 3.
Image WithOpacity(const LookedAt& view, const torch::Tensor& values, ColorEncoding encoding) {
  Image image(view.depth.camera.width, view.depth.camera.height, 4, encoding);
  const torch::Tensor plain =
      values.dim() == 1 ? values.unsqueeze(1).expand({-1, 3}).contiguous() : values.contiguous();
  for (std::size_t i = 0; i < view.seen.pixels.size(); ++i) {
    const auto p = static_cast<std::size_t>(view.seen.pixels[i]);
    std::copy_n(plain.data_ptr<float>() + 3 * i, 3, &image.pixels[4 * p]);
    image.pixels[4 * p + 3] = view.depth.opacity.pixels[p];
  }
  return image;
}

Image EnvironmentBehind(const LookedAt& view, const RelitBackground& light) {
  Image image(view.depth.camera.width, view.depth.camera.height, 4, ColorEncoding::kLinear);
  const std::vector<Eigen::Vector3f> behind = Behind(view.depth, light);
  for (std::size_t p = 0; p < behind.size(); ++p) {
    std::copy_n(behind[p].data(), 3, &image.pixels[4 * p]);
    image.pixels[4 * p + 3] = 1;
  }
  return image;
}

}  // namespace

LookedAt LookAt(const OpenedRun& run, const Relighter& relighter, const Shot& shot) {
  const SceneNormalization& frame = run.model->Scene().normalized_from_world;
  LookedAt view;
  view.rendered = run.model->Render({shot.camera, shot.world_from_camera});
  view.depth = {shot.camera, frame.NormalizedFromCamera(shot.world_from_camera),
                view.rendered.depth, view.rendered.opacity};
  view.seen = relighter.See(view.depth);
  return view;
}

Image RelitImage(const LookedAt& view, const RelitPixels& relit, const SceneFacts& scene,
                 const RelitBackground& background) {
  Image image(view.depth.camera.width, view.depth.camera.height, 4, ColorEncoding::kLinear);
  const bool is_linear = scene.encoding == ColorEncoding::kLinear;
  for (std::size_t p = 0; p < view.depth.opacity.pixels.size() && !scene.has_alpha; ++p) {
    for (int c = 0; c < 3; ++c) {
      const float shown = view.rendered.rgb.pixels[3 * p + c];
      image.pixels[4 * p + c] = is_linear ? shown : LinearFromSrgb(shown);
    }
    image.pixels[4 * p + 3] = 1;
  }
  const torch::Tensor sum = (relit.direct + relit.indirect).contiguous();
  for (std::size_t i = 0; i < view.seen.pixels.size(); ++i) {
    const auto p = static_cast<std::size_t>(view.seen.pixels[i]);
    std::copy_n(sum.data_ptr<float>() + 3 * i, 3, &image.pixels[4 * p]);
    image.pixels[4 * p + 3] = scene.has_alpha ? view.depth.opacity.pixels[p] : 1;
  }
  if (background.map == nullptr) return image;
  const std::vector<Eigen::Vector3f> behind = Behind(view.depth, background);
  for (std::size_t p = 0; p < behind.size(); ++p) {
    const float opacity = view.depth.opacity.pixels[p];
    for (int c = 0; c < 3; ++c) {
      float& value = image.pixels[4 * p + c];
      value = opacity * value + (1 - opacity) * behind[p][c];
    }
    image.pixels[4 * p + 3] = 1;
  }
  return image;
}

Image Displayed(const Image& linear, double stops, bool has_alpha) {
  const Image exposed = WithExposure(linear, stops);
  const Eigen::Vector3f background = DisplayBackground(has_alpha);
  Image shown(linear.width, linear.height, 3);
  for (std::size_t p = 0; p < shown.pixels.size() / 3; ++p) {
    const float opacity = linear.pixels[4 * p + 3];
    for (int c = 0; c < 3; ++c) {
      const float value = std::clamp(exposed.pixels[4 * p + c], 0.0f, 1.0f);
      shown.pixels[3 * p + c] = opacity * SrgbFromLinear(value) + (1 - opacity) * background[c];
    }
  }
  return shown;
}

double ExposureOf(const Image& linear) {
  Image opaque(1, 0, 3, ColorEncoding::kLinear);
  for (std::size_t p = 0; p < linear.pixels.size() / 4; ++p) {
    if (linear.pixels[4 * p + 3] < 0.5f) continue;
    for (int c = 0; c < 3; ++c) opaque.pixels.push_back(linear.pixels[4 * p + c]);
    ++opaque.height;
  }
  return opaque.height > 0 ? AutoExposure(opaque) : 0;
}

const std::vector<std::string>& ChannelNames() {
  static const std::vector<std::string> names = {"normal", "albedo",   "roughness",  "metallic",
                                                 "direct", "indirect", "visibility", "environment"};
  return names;
}

ChannelImage ChannelOf(const std::string& name, const LookedAt& view, const RelitPixels& relit,
                       const RelitBackground& light, const SceneFacts& scene) {
  const MaterialBatch& material = view.seen.material;
  const auto data = [&](const torch::Tensor& values) {
    return ChannelImage{WithOpacity(view, values, ColorEncoding::kSrgb),
                        WithOpacity(view, values, ColorEncoding::kLinear)};
  };
  const auto color = [&](const torch::Tensor& values) {
    const Image linear = WithOpacity(view, values, ColorEncoding::kLinear);
    return ChannelImage{ToSrgb(linear), linear};
  };
  const torch::Tensor zeros = torch::zeros_like(material.base_color.select(1, 0));
  const torch::Tensor metallic = material.IsMatt() ? zeros : material.metallic;
  if (name == "normal") {
    torch::Tensor frame_from_world = torch::empty({3, 3});
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        frame_from_world[r][c] = scene.normalized_from_world.rotation(r, c);
      }
    }
    const torch::Tensor in_world = torch::matmul(view.seen.normal, frame_from_world);
    return {WithOpacity(view, in_world / 2 + 0.5, ColorEncoding::kSrgb),
            WithOpacity(view, in_world, ColorEncoding::kLinear)};
  }
  if (name == "albedo") return color(material.base_color * (1 - metallic.unsqueeze(1)));
  if (name == "roughness") return data(material.IsMatt() ? zeros + 1 : material.roughness);
  if (name == "metallic") return data(metallic);
  if (name == "visibility") return data(relit.visibility);
  if (name == "direct") return color(relit.direct);
  if (name == "indirect") return color(relit.indirect);
  const Image environment = EnvironmentBehind(view, light);
  return {ToSrgb(environment), environment};
}

}  // namespace nerf
