#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/kernels/gaussian_blending.h"
#include "nerf/kernels/gaussians.h"

namespace nerf {

// Which Gaussians touch which tile of a picture, front to back.
class TileLists {
 public:
  // The lists do not depend on the number of threads. Throws InputError where they would be too
  // long.
  //   gaussians  front to back; first_slot and tiles are written
  void Build(std::span<kernels::ProjectedGaussian> gaussians, int width, int height);

  int Columns() const { return columns_; }
  int Rows() const { return rows_; }
  int Count() const { return columns_ * rows_; }
  // Of all tiles.
  std::int64_t Entries() const { return static_cast<std::int64_t>(entries_.size()); }
  kernels::Tile At(int tile) const;

 private:
  bool FindTiles(std::span<kernels::ProjectedGaussian> gaussians);
  void SumCounts();
  void FillEntries(std::span<kernels::ProjectedGaussian> gaussians);

  int columns_ = 0, rows_ = 0;
  std::vector<std::vector<std::uint32_t>> tiles_of_chunk_;  // of its Gaussians, one after another
  std::vector<std::vector<std::uint32_t>> begin_of_chunk_;  // [chunk][tile]
  std::vector<std::uint32_t> begin_;                        // [tiles + 1]
  std::vector<kernels::TileEntry> entries_;
};

}  // namespace nerf
