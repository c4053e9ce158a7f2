#pragma once

#include "nerf/synthetic/scenario.h"

namespace nerf::synthetic {

// How a sample is photographed.
struct SampleOptions {
  Scenario scenario = Scenario::kBuiltIn;
  int views = 36;             // number of photographs, 2..1000
  int width = 400;            // pixels, up to 8192
  int height = 300;           // pixels, up to 8192
  int samples_per_pixel = 9;  // rays averaged in each pixel, up to 1024
  unsigned seed = 1;          // of the irregular camera positions and of the rays in the pixels
  int threads = 0;            // 0: all cores; the pictures do not depend on it

  // Throws InputError, naming the flag, if a value is out of range.
  void Check() const;
};

}  // namespace nerf::synthetic
