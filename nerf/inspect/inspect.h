#pragma once

#include <functional>
#include <vector>

#include "nerf/inspect/verdict.h"
#include "sfm/posed_images.h"

namespace nerf {

// What a capture calls for, found from what is there before anything is trained.
struct Inspection {
  std::vector<Verdict> verdicts;
  std::vector<double> stops;  // exposure of each photograph against the mean; empty: unknown
};

// Looks at the photographs, and at the sparse points where structure from motion has left some:
// the colours of each point over the photographs that see it.
//   read  called with the number of photographs read
// Throws sfm::InputError naming a mask that is broken.
Inspection Inspect(const sfm::PosedImages& posed, const std::function<void(int)>& read = {});

}  // namespace nerf
