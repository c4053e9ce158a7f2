#include "nerf/splats/gaussian_renderer.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "nerf/base/parallel.h"
#include "nerf/kernels/gaussian_projection.h"

namespace nerf {
namespace {

using kernels::GaussianMoments;
using kernels::kGaussiansInBlock;
using kernels::kTileHeight;
using kernels::kTileWidth;
using kernels::TilePicture;

constexpr std::uint32_t kInvisible = std::numeric_limits<std::uint32_t>::max();
constexpr std::int64_t kTilesAtOnce = 8;
constexpr std::int64_t kBlocksAtOnce = 64;  // whatever the number of threads

// Copies a plane of a tile to that of a picture, or back.
template <class From, class To>
void CopyPlane(From from, int from_stride, To to, int to_stride) {
  for (int y = 0; y < kTileHeight; ++y) {
    std::copy_n(from + static_cast<std::ptrdiff_t>(y) * from_stride, kTileWidth,
                to + static_cast<std::ptrdiff_t>(y) * to_stride);
  }
}

template <class Picture, class Use>
void ForEachPlane(Picture& tile, const Use& use) {
  for (int c = 0; c < 3; ++c) use(c, tile.rgb[c].data());
  use(GaussianPicture::kTransmittance, tile.transmittance.data());
  use(GaussianPicture::kDistance, tile.distance.data());
}

void ForEachTileInParallel(const TileLists& tiles, const std::function<void(int)>& use) {
  const std::int64_t groups = (tiles.Count() + kTilesAtOnce - 1) / kTilesAtOnce;
  ParallelForEach(groups, [&](std::int64_t group) {
    const auto first = static_cast<int>(group * kTilesAtOnce);
    const int last = std::min(tiles.Count(), first + static_cast<int>(kTilesAtOnce));
    for (int tile = first; tile < last; ++tile) use(tile);
  });
}

}  // namespace

void GaussianPicture::Resize(int new_width, int new_height) {
  width = new_width;
  height = new_height;
  stride = (width + kRowPadding - 1) / kRowPadding * kRowPadding;
  rows = (height + kTileHeight - 1) / kTileHeight * kTileHeight;
  values.resize(static_cast<std::size_t>(kPlanes) * rows * stride);
}

void GaussianRenderer::ProjectAll(const kernels::GaussianCamera& camera,
                                  const GaussianParameters& parameters) {
  const std::int64_t blocks = parameters.Blocks();
  projected_.resize(static_cast<std::size_t>(blocks) * kGaussiansInBlock);
  const std::int64_t groups = (blocks + kBlocksAtOnce - 1) / kBlocksAtOnce;
  std::vector<std::int64_t> visible(groups);
  ParallelForEach(groups, [&](std::int64_t group) {
    const std::int64_t first = group * kBlocksAtOnce;
    const std::int64_t last = std::min(blocks, first + kBlocksAtOnce);
    visible[group] = kernels::ProjectGaussians(camera, parameters.order, parameters.values, first,
                                               last, &projected_[first * kGaussiansInBlock]);
  });
  // Closes the gaps between the groups.
  std::size_t end = groups > 0 ? static_cast<std::size_t>(visible[0]) : 0;
  for (std::int64_t group = 1; group < groups; ++group) {
    const auto from = projected_.begin() + group * kBlocksAtOnce * kGaussiansInBlock;
    std::copy_n(from, visible[group], projected_.begin() + static_cast<std::ptrdiff_t>(end));
    end += static_cast<std::size_t>(visible[group]);
  }
  projected_.resize(end);
}

GaussianPicture& GaussianRenderer::Draw(const kernels::GaussianCamera& camera,
                                        const GaussianParameters& parameters) {
  ProjectAll(camera, parameters);
  sorted_ = order_.Sort(projected_);
  tiles_.Build(sorted_, camera.width, camera.height);
  pictures_.resize(static_cast<std::size_t>(tiles_.Count()));
  needed_.resize(pictures_.size());
  picture_.Resize(camera.width, camera.height);
  ForEachTileInParallel(tiles_, [&](int index) {
    const kernels::Tile tile = tiles_.At(index);
    needed_[index] = kernels::BlendTile(sorted_, tile, pictures_[index]);
    ForEachPlane(pictures_[index], [&](int plane, const float* values) {
      float* const corner =
          picture_.Plane(plane) + static_cast<std::ptrdiff_t>(tile.y) * picture_.stride + tile.x;
      CopyPlane(values, kTileWidth, corner, picture_.stride);
    });
  });
  return picture_;
}

GaussianMoments GaussianRenderer::MomentsOf(std::uint32_t position) const {
  const kernels::ProjectedGaussian& g = sorted_[position];
  GaussianMoments sum;
  for (std::uint32_t k = 0; k < g.tiles; ++k) {
    const GaussianMoments& m = moments_[g.first_slot + k];
    sum.sum += m.sum;
    sum.x += m.x;
    sum.y += m.y;
    sum.xx += m.xx;
    sum.xy += m.xy;
    sum.yy += m.yy;
    for (int c = 0; c < 3; ++c) sum.rgb[c] += m.rgb[c];
    sum.distance += m.distance;
  }
  return sum;
}

kernels::CameraGradient GaussianRenderer::Backward(const kernels::GaussianCamera& camera,
                                                   const GaussianParameters& parameters,
                                                   const GaussianPicture& dL_dpicture,
                                                   bool with_pose, const Sink& sink) {
  moments_.resize(static_cast<std::size_t>(tiles_.Entries()));
  ForEachTileInParallel(tiles_, [&](int index) {
    kernels::Tile tile = tiles_.At(index);
    TilePicture gradient;
    ForEachPlane(gradient, [&](int plane, float* values) {
      const float* const corner = dL_dpicture.Plane(plane) +
                                  static_cast<std::ptrdiff_t>(tile.y) * dL_dpicture.stride + tile.x;
      CopyPlane(corner, dL_dpicture.stride, values, kTileWidth);
    });
    for (const kernels::TileEntry& hidden : tile.entries.subspan(needed_[index])) {
      moments_[hidden.slot] = {};
    }
    tile.entries = tile.entries.first(needed_[index]);
    kernels::BlendTileBackward(sorted_, tile, pictures_[index], gradient, moments_);
  });

  const std::int64_t blocks = parameters.Blocks();
  position_of_.assign(static_cast<std::size_t>(blocks) * kGaussiansInBlock, kInvisible);
  for (std::uint32_t i = 0; i < sorted_.size(); ++i) position_of_[sorted_[i].index] = i;
  const std::int64_t groups = (blocks + kBlocksAtOnce - 1) / kBlocksAtOnce;
  std::vector<kernels::CameraGradient> poses(groups);
  ParallelForEach(groups, [&](std::int64_t group) {
    std::array<float, kernels::kMostGaussianRows * kGaussiansInBlock> gradients;
    std::array<float, kGaussiansInBlock> on_screen;
    const std::span<float> of_block = std::span(gradients).first(
        static_cast<std::size_t>(kernels::GaussianRows(parameters.order)) * kGaussiansInBlock);
    const std::int64_t last = std::min(blocks, (group + 1) * kBlocksAtOnce);
    for (std::int64_t block = group * kBlocksAtOnce; block < last; ++block) {
      std::array<GaussianMoments, kGaussiansInBlock> moments{};
      bool any = false;
      for (int l = 0; l < kGaussiansInBlock; ++l) {
        const std::uint32_t position = position_of_[block * kGaussiansInBlock + l];
        if (position == kInvisible) continue;
        any = true;
        moments[l] = MomentsOf(position);
      }
      if (!any) continue;
      kernels::ProjectGaussiansBackward(camera, parameters.order, parameters.Block(block),
                                        {moments, of_block, on_screen},
                                        with_pose ? &poses[group] : nullptr);
      sink(block, of_block, on_screen);
    }
  });
  kernels::CameraGradient sum;
  for (const kernels::CameraGradient& pose : poses) {
    for (int k = 0; k < 3; ++k) {
      sum.turned[k] += pose.turned[k];
      sum.moved[k] += pose.moved[k];
    }
  }
  return sum;
}

}  // namespace nerf
