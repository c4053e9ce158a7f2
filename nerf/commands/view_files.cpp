#include "nerf/commands/view_files.h"

#include <Eigen/Core>
#include <cstddef>

#include "nerf/image/image_io.h"
#include "nerf/output/color_map.h"

namespace nerf {
namespace {

// Median depth and normals in the frame and units of the input, and normals as colours.
void WriteSurface(const RenderedView& view, const SceneFacts& scene,
                  const std::filesystem::path& stem) {
  Image depth = view.median_depth, normal = view.normal;
  for (float& d : depth.pixels) {
    d = static_cast<float>(scene.normalized_from_world.LengthWorldFromNormalized(d));
  }
  const Eigen::Matrix3f world_from_normalized =
      scene.normalized_from_world.rotation.transpose().cast<float>();
  for (std::size_t p = 0; p < normal.pixels.size(); p += 3) {
    Eigen::Map<Eigen::Vector3f> n(&normal.pixels[p]);
    n = world_from_normalized * n;
  }
  WriteImage(stem.string() + ".median_depth.exr", depth);
  WriteImage(stem.string() + ".normal.exr", normal);
  normal.encoding = ColorEncoding::kSrgb;  // no colours: values are written unchanged
  for (float& value : normal.pixels) value = 0.5f + 0.5f * value;
  WriteImage(stem.string() + ".normal.png", normal);
}

}  // namespace

void AddViewFiles(CLI::App& command, ViewFiles& files) {
  command.add_option("--format", files.format, "png, jpg, or exr (linear)")
      ->check(CLI::IsMember({"png", "jpg", "exr"}))
      ->capture_default_str();
  command.add_flag("--depth", files.depth,
                   "also write depth along the ray: EXR in the input's units, and a colour map");
  command.add_flag("--opacity", files.opacity, "also write opacity, as PNG");
  command.add_flag("--surface", files.surface,
                   "also write median depth and normals: EXR in the input's units and frame, and "
                   "normals as PNG; of Gaussians only");
}

void WriteView(const RenderedView& view, const SceneFacts& scene, const ViewFiles& files,
               const std::filesystem::path& stem) {
  WriteImage(stem.string() + "." + files.format, view.rgb);
  if (files.depth) {
    Image depth = view.depth;
    for (float& d : depth.pixels) {
      d = static_cast<float>(scene.normalized_from_world.LengthWorldFromNormalized(d));
    }
    WriteImage(stem.string() + ".depth.exr", depth);
    WriteImage(stem.string() + ".depth.png", ColorizeDepth(depth, view.opacity));
  }
  if (files.surface) WriteSurface(view, scene, stem);
  if (files.opacity) {
    Image opacity = view.opacity;
    opacity.encoding = ColorEncoding::kSrgb;  // a mask: values are written unchanged
    WriteImage(stem.string() + ".opacity.png", opacity);
  }
}

}  // namespace nerf
