#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "nerf/scene/dataset.h"

namespace nerf {

// Right halves of some photographs to learn from, held out for validation until this goes away: on
// one photograph a difference of tenths of a decibel is chance. Their left halves are learned from,
// so that what belongs to a photograph (its pose) is known of all that are measured on.
// Source: Martin-Brualla et al. 2021, "NeRF in the Wild", section 5.
class HeldOutHalves {
 public:
  // Halves of eight photographs, of every four one at most, spread over the capture. Photographs
  // that hold no pixels in one of their halves are passed over.
  //   data  meanwhile validates on these alone; as it was afterwards, in the same order
  explicit HeldOutHalves(Dataset& data);
  ~HeldOutHalves();
  HeldOutHalves(const HeldOutHalves&) = delete;
  HeldOutHalves& operator=(const HeldOutHalves&) = delete;

  std::size_t Count() const { return wholes_.size(); }

 private:
  Dataset& data_;
  std::vector<std::pair<std::size_t, View>> wholes_;  // photographs by their place
  std::vector<View> validation_;                      // that was there
};

// The view as a camera would have taken it that shows the columns [left, right) alone.
View ColumnsOf(const View& view, int left, int right);

}  // namespace nerf
