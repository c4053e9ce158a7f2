#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/scene/dataset.h"

namespace nerf {

// Where in the photographs the field is still wrong: a running mean of the squared error for each
// square of pixels, and pixels drawn as often as their square is wrong. Rays are so spent on edges
// and fur and not on walls that are right already. Source: the error map of Mueller et al. 2022,
// "Instant Neural Graphics Primitives".
class ErrorMap {
 public:
  struct Pixel {
    std::size_t view = 0;
    std::int64_t index = 0;  // y * width + x
  };

  // Starts with the same error everywhere: a cell of which nothing is known counts as wrong as the
  // others are in the mean. `views` must outlive it.
  explicit ErrorMap(const std::vector<View>& views);

  std::int64_t CellOf(const Pixel& pixel) const;

  // A pixel for 64 random bits: its cell with a probability in proportion to error times size, then
  // each pixel of the cell alike.
  Pixel Draw(std::uint64_t bits) const;

  // Takes over what a batch has shown.
  //   cells          [R]
  //   squared_error  [R] of a ray, the mean over its channels; above 1, as of a sun in linear
  //                  radiance, it counts as 1
  void Learn(std::span<const std::int64_t> cells, std::span<const float> squared_error);

  // [cells], all of the map's state, to be kept and to be taken over; -1 where nothing is known.
  // Throws InputError when the number differs (the photographs are others) or when they are no
  // errors.
  std::span<const float> Errors() const { return error_; }
  void SetErrors(std::span<const float> errors);

 private:
  void Accumulate();
  std::int64_t CellsAcross(std::size_t view) const;

  const std::vector<View>& views_;
  std::int64_t edge_ = 0;                 // of a cell, pixels
  std::vector<std::int64_t> first_cell_;  // [views+1] running count
  std::vector<float> error_, size_;       // [cells]; pixels
  std::vector<double> until_;             // [cells] running sum of error times size
};

}  // namespace nerf
