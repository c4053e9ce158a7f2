#pragma once

#include <cstddef>
#include <vector>

#include "nerf/data/dataset.h"
#include "nerf/train/model.h"

namespace nerf {

// Some of the photographs to learn from, held out for validation until this goes away: on one
// photograph a difference of tenths of a decibel is chance.
class HeldOut {
 public:
  // Holds out as many as make four with those that are for validation already, of every eight one
  // at most, spread over the capture.
  //   data   as it was afterwards, in the same order
  //   scene  tells of data.train before; returned as it is meanwhile
  HeldOut(Dataset& data, SceneFacts scene);
  ~HeldOut();
  HeldOut(const HeldOut&) = delete;
  HeldOut& operator=(const HeldOut&) = delete;

  const SceneFacts& Scene() const { return scene_; }

 private:
  Dataset& data_;
  SceneFacts scene_;
  std::vector<std::size_t> places_;  // among those to learn from, rising
};

}  // namespace nerf
