#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nerf/commands/shots.h"
#include "nerf/light/environment_map.h"
#include "nerf/relight/relit_view.h"
#include "nerf/render/image_renderer.h"

namespace nerf {

// A view of a run with materials, before light falls on it.
struct LookedAt {
  RenderedView rendered;  // by the field
  DepthMap depth;
  SeenSurface seen;
};

LookedAt LookAt(const OpenedRun& run, const Relighter& relighter, const Shot& shot);

// What stands behind a relit surface.
struct RelitBackground {
  const EnvironmentMap* map = nullptr;  // null: transparent, or as the field shows it
  Eigen::Matrix3d map_from_frame = Eigen::Matrix3d::Identity();
  float gain = 1;
};

// The view under a light, linear, 4 channels: straight colour and opacity. Without a map, what is
// not part of the surface stays as the field shows it, where photographs have no alpha.
Image RelitImage(const LookedAt& view, const RelitPixels& relit, const SceneFacts& scene,
                 const RelitBackground& background);

// As it is displayed: before white or black where it is transparent, in sRGB, 3 channels.
Image Displayed(const Image& linear, double stops, bool has_alpha);

// Stops that put the bright parts of what is opaque just below white.
double ExposureOf(const Image& linear);

// What `nerf render --channel` shows.
const std::vector<std::string>& ChannelNames();

// A channel of a view, with opacity, as it is in a PNG: normals n / 2 + 1/2 in the axes of the
// input, colours in sRGB, roughness, metallic and visibility as they are; and linear, as in an EXR.
struct ChannelImage {
  Image display, linear;
};
//   name   of ChannelNames()
//   light  that shines
ChannelImage ChannelOf(const std::string& name, const LookedAt& view, const RelitPixels& relit,
                       const RelitBackground& light, const SceneFacts& scene);

}  // namespace nerf
