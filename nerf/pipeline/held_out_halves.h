#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "nerf/scene/dataset.h"

namespace nerf {

// Holds out the right halves of some training photographs for validation during its lifetime. Their
// left halves are trained on, so that parameters per photograph (its pose) are learned for all
// validation photographs. Several photographs are needed, because differences of tenths of a
// decibel on one are not significant. Source: Martin-Brualla et al. 2021, "NeRF in the Wild",
// section 5.
class HeldOutHalves {
 public:
  // Halves of eight photographs, but at most one in four, spread over the capture. Photographs
  // without pixels in one of their halves are skipped.
  //   data  validates on these halves only; restored by the destructor, in the same order
  explicit HeldOutHalves(Dataset& data);
  ~HeldOutHalves();
  HeldOutHalves(const HeldOutHalves&) = delete;
  HeldOutHalves& operator=(const HeldOutHalves&) = delete;

  std::size_t Count() const { return wholes_.size(); }

 private:
  Dataset& data_;
  std::vector<std::pair<std::size_t, View>> wholes_;  // whole photographs, by index
  std::vector<View> validation_;                      // the original validation views
};

// The view cropped to the columns [left, right), with a camera for that part.
View ColumnsOf(const View& view, int left, int right);

}  // namespace nerf
