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

// Remembers where contracted space may hold matter, so that rays step over the rest.
// Source: Mueller et al. 2022, appendix E.2 ("occupancy grids"): the maximum of the decayed memory
// and a fresh density at a random point of the cell.
class OccupancyGrid {
 public:
  // step_length: the marcher's step in contracted space, which turns densities into opacities.
  // All cells start as occupied.
  OccupancyGrid(const OccupancyOptions& options, float step_length);

  const OccupancyOptions& Options() const { return options_; }

  // Whether the cell of a position in the unit cube may hold matter. Outside the cube: no.
  bool Occupied(const Eigen::Vector3f& position) const {
    const std::int64_t cell = CellOf(position);
    return cell >= 0 && occupied_[cell] != 0;
  }

  // How far all cells are empty about a position in an empty cell, in units of contracted space; 0
  // next to matter. Found block by block, so a bound and not the distance itself.
  float FreeRadius(const Eigen::Vector3f& position) const;

  // Cells for which `visible(centre and half diagonal of the cell, in the unit cube)` is false are
  // empty for good: what no training photograph sees cannot be learned, only dreamt.
  void KeepVisible(const std::function<bool(const Eigen::Vector3f&, float)>& visible);

  // Draws fresh densities for a random quarter of the occupied cells and an eighth of the others (a
  // quarter too during warm-up), then decides anew which cells are occupied.
  //   density  positions [N,3] in the unit cube -> [N], 1 / unit of contracted space
  using DensityFunction = std::function<std::vector<float>(std::span<const float>)>;
  void Update(std::int64_t step, std::uint64_t seed, const DensityFunction& density);

  double OccupiedFraction() const;

  // The state that a checkpoint keeps.
  std::vector<float>& Density() { return density_; }  // [cells] remembered, -1: never seen
  const std::vector<float>& Density() const { return density_; }
  void Refresh();  // decides from Density() which cells are occupied

 private:
  void Decided();  // brings what follows from occupied_ up to date
  std::int64_t CellOf(const Eigen::Vector3f& position) const;
  Eigen::Vector3f CellCorner(std::int64_t cell) const;

  OccupancyOptions options_;
  float step_length_;
  std::vector<float> density_;
  std::vector<std::uint8_t> occupied_;
  int blocks_;                                // along an axis, of kBlock cells each way
  std::vector<std::uint8_t> block_distance_;  // blocks to the nearest with an occupied cell, 0: has
};

}  // namespace nerf
