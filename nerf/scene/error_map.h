#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/scene/view.h"

namespace nerf {

// Importance sampling of pixels by training error: the photographs are divided into square cells of
// pixels, each with a running mean of its squared error, and a cell is drawn in proportion to it.
// Rays so go to edges and fur, not to walls that are converged. Source: the error map of Mueller et
// al. 2022, "Instant Neural Graphics Primitives".
class ErrorMap {
 public:
  struct Pixel {
    std::size_t view = 0;
    std::int64_t index = 0;  // y * width + x
  };

  // Starts with the same error everywhere: a cell without an estimate counts with the mean of the
  // others. `views` must outlive the map.
  explicit ErrorMap(const std::vector<View>& views);

  std::int64_t CellOf(const Pixel& pixel) const;

  // The pixel that 64 random bits select: a cell with probability proportional to error times
  // number of pixels, then a pixel of the cell uniformly.
  Pixel Draw(std::uint64_t bits) const;

  // Updates the running means with the errors of a batch.
  //   cells          [R] from CellOf
  //   squared_error  [R] per ray, mean over the channels; clamped to 1 (a sun in linear radiance
  //                  exceeds it)
  void Update(std::span<const std::int64_t> cells, std::span<const float> squared_error);

  // The state of the map for checkpoints: [cells], -1 where a cell has no estimate.
  std::span<const float> Errors() const { return error_; }
  // Throws InputError when the number of cells differs (the photographs have changed) or when a
  // value is no error.
  void SetErrors(std::span<const float> errors);

 private:
  void UpdateCumulative();
  std::int64_t CellsAcross(std::size_t view) const;

  const std::vector<View>& views_;
  std::int64_t edge_ = 0;                 // side of a cell, pixels
  std::vector<std::int64_t> first_cell_;  // [views+1] running count
  std::vector<float> error_, size_;       // [cells]; size in pixels
  std::vector<double> cumulative_;        // [cells] running sum of error times size
};

}  // namespace nerf
