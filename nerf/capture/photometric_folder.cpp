#include "nerf/capture/photometric_folder.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/base/quantile.h"
#include "nerf/capture/normal_integration.h"
#include "nerf/geometry/height_mesh.h"
#include "nerf/geometry/ply_file.h"
#include "nerf/image/image_convert.h"
#include "nerf/image/image_io.h"
#include "nerf/output/color_map.h"

namespace nerf {
namespace {

constexpr double kUnclipped = 0.98;      // fraction of the albedos that are not clipped in pictures
constexpr float kWhiteResidual = 0.10f;  // relative to the albedo

// The factor with which albedos of any unit fill the range of a picture.
float DisplayScale(const Image& albedo) {
  std::vector<float> values;
  std::ranges::copy_if(albedo.pixels, std::back_inserter(values), [](float v) { return v > 0; });
  if (values.empty()) return 1;
  return 1 / Quantile(values, kUnclipped);
}

Image Scaled(Image image, float factor) {
  for (float& value : image.pixels) value *= factor;
  return image;
}

Image ResidualAsColors(const Image& residual) {
  Image picture(residual.width, residual.height, 3, ColorEncoding::kSrgb);
  for (std::size_t i = 0; i < residual.pixels.size(); ++i) {
    const Eigen::Vector3f color = Heat(residual.pixels[i] / kWhiteResidual);
    std::copy_n(color.data(), 3, &picture.pixels[i * 3]);
  }
  return picture;
}

}  // namespace

void WritePhotometricFolder(const std::filesystem::path& folder, const PhotometricMaps& maps) {
  MakeOutputFolder(folder);
  const float scale = DisplayScale(maps.albedo);
  const DirectionalLight upper_left{Eigen::Vector3d(-0.6, 0.5, 0.62).normalized()};
  WriteImage(folder / "normals.exr", maps.normal);
  WriteImage(folder / "normals.png", NormalsAsColors(maps.normal));
  WriteImage(folder / "albedo.exr", maps.albedo);
  WriteImage(folder / "albedo.png", Scaled(maps.albedo, scale));
  WriteImage(folder / "residual.exr", maps.residual);
  WriteImage(folder / "residual.png", ResidualAsColors(maps.residual));
  WriteImage(folder / "relit.png", Scaled(RelitByNormals(maps, upper_left), scale));
  // Above the limit of IntegrateNormals the maps are reduced first.
  const double ratio = static_cast<double>(maps.pixels) / kMaxHeightPixels;
  const int block = std::max(1, static_cast<int>(std::ceil(std::sqrt(ratio))));
  WritePly(folder / "depth.ply", MeshFromHeights(IntegrateNormals(Downscale(maps.normal, block)),
                                                 Downscale(Scaled(maps.albedo, scale), block)));
}

}  // namespace nerf
