#include "nerf/splats/tile_lists.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"

namespace nerf {
namespace {

using kernels::kTileHeight;
using kernels::kTileWidth;
using kernels::ProjectedGaussian;

constexpr std::int64_t kMostEntries = 150000000;  // 2 GB, with their gradients 8 GB
constexpr std::size_t kCountedAtOnce = 1 << 16;   // entries
constexpr std::int64_t kChunks = 16;              // whatever the number of threads

// The first Gaussian of a chunk.
std::int64_t FirstOf(std::int64_t chunk, std::span<const ProjectedGaussian> gaussians) {
  return static_cast<std::int64_t>(gaussians.size()) * chunk / kChunks;
}

// Calls use(tile) for the tiles that the ellipse of a Gaussian touches, row after row. Where it is
// cut it is q = xx dx^2 + xy dx dy + yy dy^2 = least - log2_opacity, negative.
template <class Use>
void ForEachTile(const ProjectedGaussian& g, int columns, int rows, const Use& use) {
  // Not far beyond the picture, so that an int holds it however large the Gaussian is.
  const auto tile_of = [](float position, int size, int count) {
    const float tile =
        std::clamp(position / static_cast<float>(size), -1.0f, static_cast<float>(count));
    const int towards_zero = static_cast<int>(tile);  // std::floor is a call before SSE4
    return towards_zero - static_cast<int>(tile < static_cast<float>(towards_zero));
  };
  // The first and last pixel centre inside.
  const int top = std::max(0, tile_of(g.y - g.radius_y - 0.5f, kTileHeight, rows));
  const int bottom = std::min(rows - 1, tile_of(g.y + g.radius_y - 0.5f, kTileHeight, rows));
  const int left = std::max(0, tile_of(g.x - g.radius_x - 0.5f, kTileWidth, columns));
  const int right = std::min(columns - 1, tile_of(g.x + g.radius_x - 0.5f, kTileWidth, columns));
  if (top == bottom || left == right) {
    for (int row = top; row <= bottom; ++row) {
      for (int column = left; column <= right; ++column) use(row * columns + column);
    }
    return;
  }
  const float a = -g.xx, b = -0.5f * g.xy, c = -g.yy, level = g.log2_opacity - g.least;
  const float det = std::max(a * c - b * b, 0.0f);
  const float dy_of_rightmost = -b / c * g.radius_x;
  for (int row = top; row <= bottom; ++row) {
    // The pixel centres of the row of tiles.
    const float y0 = static_cast<float>(row * kTileHeight) + 0.5f - g.y;
    const float y1 = y0 + static_cast<float>(kTileHeight - 1);
    const float at_right = std::clamp(dy_of_rightmost, y0, y1);
    const float at_left = std::clamp(-dy_of_rightmost, y0, y1);
    const float root_right = std::max(level * a - det * at_right * at_right, 0.0f);
    const float root_left = std::max(level * a - det * at_left * at_left, 0.0f);
    const float x1 = g.x + (-b * at_right + std::sqrt(root_right)) / a;
    const float x0 = g.x + (-b * at_left - std::sqrt(root_left)) / a;
    // Half a pixel more, against rounding.
    // Where rounding leaves no number, the whole row.
    const int first = x1 >= x0 ? std::max(left, tile_of(x0 - 1.0f, kTileWidth, columns)) : left;
    const int last = x1 >= x0 ? std::min(right, tile_of(x1, kTileWidth, columns)) : right;
    for (int column = first; column <= last; ++column) use(row * columns + column);
  }
}

}  // namespace

void TileLists::Build(std::span<ProjectedGaussian> gaussians, int width, int height) {
  columns_ = (width + kTileWidth - 1) / kTileWidth;
  rows_ = (height + kTileHeight - 1) / kTileHeight;
  if (!FindTiles(gaussians)) {
    throw InputError(
        "{} Gaussians cover more than {} million tiles of a picture of {}x{}; use fewer, or a "
        "smaller picture",
        gaussians.size(), kMostEntries / 1000000, width, height);
  }
  SumCounts();
  FillEntries(gaussians);
}

// Finds the tiles of each Gaussian, and how many Gaussians of a chunk each tile has. False if they
// are too many.
bool TileLists::FindTiles(std::span<ProjectedGaussian> gaussians) {
  tiles_of_chunk_.resize(kChunks);
  begin_of_chunk_.resize(kChunks);
  std::atomic<std::int64_t> entries = 0;
  ParallelForEach(kChunks, [&](std::int64_t chunk) {
    std::vector<std::uint32_t>& tiles = tiles_of_chunk_[chunk];
    std::vector<std::uint32_t>& counts = begin_of_chunk_[chunk];
    std::size_t counted = 0;
    tiles.clear();
    counts.assign(static_cast<std::size_t>(Count()), 0);
    for (std::int64_t i = FirstOf(chunk, gaussians); i < FirstOf(chunk + 1, gaussians); ++i) {
      // Rarely, since threads that count in one place wait for each other.
      if (tiles.size() - counted >= kCountedAtOnce) {
        entries += static_cast<std::int64_t>(tiles.size() - counted);
        counted = tiles.size();
        if (entries > kMostEntries) return;
      }
      const std::size_t before = tiles.size();
      ForEachTile(gaussians[i], columns_, rows_, [&](int tile) {
        tiles.push_back(static_cast<std::uint32_t>(tile));
        ++counts[tile];
      });
      gaussians[i].first_slot = static_cast<std::uint32_t>(before);
      gaussians[i].tiles = static_cast<std::uint32_t>(tiles.size() - before);
    }
    entries += static_cast<std::int64_t>(tiles.size() - counted);
  });
  return entries <= kMostEntries;
}

// From how many entries each chunk has in a tile to where the first of them stands.
void TileLists::SumCounts() {
  begin_.resize(static_cast<std::size_t>(Count()) + 1);
  std::uint32_t sum = 0;
  for (int tile = 0; tile < Count(); ++tile) {
    begin_[tile] = sum;
    for (auto& counts : begin_of_chunk_) {
      const std::uint32_t in_chunk = counts[tile];
      counts[tile] = sum;
      sum += in_chunk;
    }
  }
  begin_.back() = sum;
}

void TileLists::FillEntries(std::span<ProjectedGaussian> gaussians) {
  entries_.resize(begin_.back());
  std::vector<std::uint32_t> first_slot(kChunks, 0);
  for (std::int64_t chunk = 1; chunk < kChunks; ++chunk) {
    first_slot[chunk] =
        first_slot[chunk - 1] + static_cast<std::uint32_t>(tiles_of_chunk_[chunk - 1].size());
  }
  ParallelForEach(kChunks, [&](std::int64_t chunk) {
    std::vector<std::uint32_t>& next = begin_of_chunk_[chunk];
    for (std::int64_t i = FirstOf(chunk, gaussians); i < FirstOf(chunk + 1, gaussians); ++i) {
      ProjectedGaussian& g = gaussians[i];
      const std::uint32_t* const tiles = tiles_of_chunk_[chunk].data() + g.first_slot;
      g.first_slot += first_slot[chunk];
      for (std::uint32_t k = 0; k < g.tiles; ++k) {
        entries_[next[tiles[k]]++] = {static_cast<std::uint32_t>(i), g.first_slot + k};
      }
    }
  });
}

kernels::Tile TileLists::At(int tile) const {
  return {tile % columns_ * kTileWidth, tile / columns_ * kTileHeight,
          std::span(entries_).subspan(begin_[tile], begin_[tile + 1] - begin_[tile])};
}

}  // namespace nerf
