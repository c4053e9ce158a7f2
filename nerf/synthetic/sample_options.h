#pragma once

#include "nerf/synthetic/occasion.h"

namespace nerf::synthetic {

// How the sample is photographed.
struct SampleOptions {
  Occasion occasion = Occasion::kBuiltIn;
  int views = 36;             // photographs, 2..1000
  int width = 400;            // pixels, up to 8192
  int height = 300;           // pixels, up to 8192
  int samples_per_pixel = 9;  // rays averaged in each pixel, up to 1024
  unsigned seed = 1;          // of the cameras' irregularity and the rays' places in the pixels
  int threads = 0;            // 0: as many as the machine has; the pictures do not depend on it

  // Throws InputError, naming the flag, where a value is out of range.
  void Check() const;
};

}  // namespace nerf::synthetic
