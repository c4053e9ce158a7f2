#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "nerf/base/options.h"

namespace nerf {

struct OccupancyOptions {
  int resolution = 128;
  double decay = 0.8;
  double threshold = 0.03;
  int warmup_steps = 256;
  int update_every = 16;
  int coarse_to_fine_steps = 1000;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("resolution", o.resolution, "cells", Between(2, 512),
           "along an axis of contracted space");
    option("decay", o.decay, "", StrictlyBetween(0, 1),
           "of a cell's remembered density each time that it is drawn again");
    option("threshold", o.threshold, "opacity", StrictlyBetween(0, 1),
           "of one marching step at which a cell counts as occupied");
    option("warmup_steps", o.warmup_steps, "steps", AtLeast(0),
           "during which empty cells are drawn as often as others");
    option("update_every", o.update_every, "steps", AtLeast(1), "between updates of the grid");
    option("coarse_to_fine_steps", o.coarse_to_fine_steps, "steps", AtLeast(0),
           "until the field shows full detail; not where a proposal network places the samples");
  }
};

// Marks the cells of contracted space that may be occupied, so that rays skip the others. A cell
// stores the maximum of its decayed density and a new one at a random point of the cell.
// Source: Mueller et al. 2022, appendix E.2 ("occupancy grids").
class OccupancyGrid {
 public:
  // All cells start as occupied.
  //   step_length  of the ray marcher in contracted space, to convert densities into opacities
  OccupancyGrid(const OccupancyOptions& options, float step_length);

  const OccupancyOptions& Options() const { return options_; }

  // Whether the cell of a position in the unit cube is occupied; false outside the cube.
  bool Occupied(const Eigen::Vector3f& position) const {
    const std::int64_t cell = CellOf(position);
    return cell >= 0 && occupied_[cell] != 0;
  }

  // A radius around a position in an empty cell within which all cells are empty, in units of
  // contracted space; 0 next to occupied cells. A lower bound, since it is found by blocks of
  // cells.
  float FreeRadius(const Eigen::Vector3f& position) const;

  // Marks cells for which `visible(centre, half diagonal)` of the cell, in the unit cube, is false
  // as permanently empty: no training photograph sees them, so nothing there can be learned.
  void KeepVisible(const std::function<bool(const Eigen::Vector3f&, float)>& visible);

  // Samples the density in a random quarter of the occupied cells and an eighth of the others (a
  // quarter during warm-up), then updates which cells are occupied.
  //   density  positions [N,3] in the unit cube -> [N], 1 / unit of contracted space
  using DensityFunction = std::function<std::vector<float>(std::span<const float>)>;
  void Update(std::int64_t step, std::uint64_t seed, const DensityFunction& density);

  double OccupiedFraction() const;

  // The state for checkpoints.
  std::vector<float>& Density() { return density_; }  // [cells] stored, -1: never visible
  const std::vector<float>& Density() const { return density_; }
  void Refresh();  // updates from Density() which cells are occupied

 private:
  void UpdateBlockDistances();  // from occupied_
  std::int64_t CellOf(const Eigen::Vector3f& position) const;
  Eigen::Vector3f CellCorner(std::int64_t cell) const;

  OccupancyOptions options_;
  float step_length_;
  std::vector<float> density_;
  std::vector<std::uint8_t> occupied_;
  int blocks_;  // along an axis, of kBlock^3 cells each
  // Chessboard distance of each block to the nearest block with an occupied cell, in blocks.
  std::vector<std::uint8_t> block_distance_;
};

}  // namespace nerf
