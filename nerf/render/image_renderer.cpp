#include "nerf/render/image_renderer.h"

#include <algorithm>
#include <vector>

#include "nerf/scene/camera.h"
#include "nerf/scene/pixel_sampler.h"

namespace nerf {
namespace {

constexpr int kBlock = 4;   // side of a block, pixels
constexpr int kTile = 256;  // blocks per rendered batch

// Appends the pixels of block number `block`, counted in rows of blocks. In their order, every four
// are a square of 2 x 2. Pixels beyond the edge repeat those at the edge.
void AppendBlock(const Camera& camera, std::int64_t block, std::vector<std::int64_t>& pixels) {
  const int across = (camera.width + kBlock - 1) / kBlock;
  const auto left = static_cast<int>(block % across) * kBlock;
  const auto top = static_cast<int>(block / across) * kBlock;
  for (int i = 0; i < kBlock * kBlock; ++i) {
    const int x = std::min(left + (i & 1) + (i >> 1 & 2), camera.width - 1);
    const int y = std::min(top + (i >> 1 & 1) + (i >> 2 & 2), camera.height - 1);
    pixels.push_back(static_cast<std::int64_t>(y) * camera.width + x);
  }
}

// Pixels outside the lens's field of view get the ray of another pixel of their block, so that the
// block's mean ray stays valid, or of any pixel if the block has no valid ray. Their colours are
// replaced later.
void FillInvalidRays(ViewRays& tile) {
  const std::int64_t count = tile.rays.Size();
  const auto first_valid = [&](std::int64_t begin, std::int64_t end) {
    const auto found = std::find(tile.valid.begin() + begin, tile.valid.begin() + end, 1);
    return found == tile.valid.begin() + end ? count : found - tile.valid.begin();
  };
  const std::int64_t any = first_valid(0, count);
  constexpr std::int64_t kPixels = kBlock * kBlock;
  for (std::int64_t begin = 0; begin < count; begin += kPixels) {
    std::int64_t source = first_valid(begin, begin + kPixels);
    if (source == count) source = any;
    for (std::int64_t r = begin; r < begin + kPixels; ++r) {
      if (tile.valid[r]) source = r;
      if (tile.valid[r] || source == count) continue;
      std::copy_n(&tile.rays.origin[3 * source], 3, &tile.rays.origin[3 * r]);
      std::copy_n(&tile.rays.direction[3 * source], 3, &tile.rays.direction[3 * r]);
      tile.rays.spread[r] = tile.rays.spread[source];
    }
  }
}

}  // namespace

RenderedView RenderView(const RayRenderer& renderer, const Camera& camera,
                        const Eigen::Isometry3d& normalized_from_camera,
                        const Eigen::Vector3f& background, ColorEncoding encoding,
                        const std::function<void(std::int64_t)>& progress) {
  RenderedView view;
  view.rgb = Image(camera.width, camera.height, 3, encoding);
  view.opacity = Image(camera.width, camera.height, 1, ColorEncoding::kLinear);
  view.depth = Image(camera.width, camera.height, 1, ColorEncoding::kLinear);
  const std::int64_t across = (camera.width + kBlock - 1) / kBlock;
  const std::int64_t blocks = across * ((camera.height + kBlock - 1) / kBlock);
  const std::int64_t all = static_cast<std::int64_t>(camera.width) * camera.height;
  std::vector<std::int64_t> pixels;
  for (std::int64_t first = 0; first < blocks; first += kTile) {
    const std::int64_t last = std::min(blocks, first + kTile);
    pixels.clear();
    for (std::int64_t block = first; block < last; ++block) AppendBlock(camera, block, pixels);
    ViewRays tile = RaysOfPixels(camera, normalized_from_camera, pixels, background);
    const bool any = std::ranges::find(tile.valid, 1) != tile.valid.end();
    FillInvalidRays(tile);
    const RenderOutput out = any ? renderer.Render(tile.rays) : RenderOutput{};
    view.samples += out.samples;
    view.seconds.Add(out.seconds);
    for (std::size_t r = 0; r < pixels.size(); ++r) {
      const std::int64_t pixel = pixels[r];
      float* const rgb = &view.rgb.pixels[3 * pixel];
      if (tile.valid[r]) {
        std::copy_n(&out.rgb[3 * r], 3, rgb);
        view.opacity.pixels[pixel] = out.opacity[r];
        view.depth.pixels[pixel] = out.depth[r];
      } else {
        std::copy_n(background.data(), 3, rgb);
      }
    }
    if (progress) progress(std::min(all, all * last / blocks));
  }
  return view;
}

Image RenderPreview(const RayRenderer& renderer, const Camera& camera, int factor,
                    const Eigen::Isometry3d& normalized_from_camera,
                    const Eigen::Vector3f& background, ColorEncoding encoding) {
  factor = std::clamp(factor, 1, std::min(camera.width, camera.height));
  const Camera coarse = Downscaled(camera, factor);
  const RenderedView view =
      RenderView(renderer, coarse, normalized_from_camera, background, encoding);
  Image image(camera.width, camera.height, 3, encoding);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const int from_x = std::min(x / factor, coarse.width - 1);
      const int from_y = std::min(y / factor, coarse.height - 1);
      std::copy_n(&view.rgb.pixels[3 * (static_cast<std::size_t>(from_y) * coarse.width + from_x)],
                  3, &image.pixels[3 * (static_cast<std::size_t>(y) * camera.width + x)]);
    }
  }
  return image;
}

}  // namespace nerf
