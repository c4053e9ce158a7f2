#include "nerf/synthetic/sample_options.h"

#include "nerf/synthetic/check_range.h"

namespace nerf::synthetic {

void SampleOptions::Check() const {
  CheckRange("--views", views, 2, 1000);
  CheckRange("--width", width, 1, 8192);
  CheckRange("--height", height, 1, 8192);
  CheckRange("--samples", samples_per_pixel, 1, 1024);
  CheckRange("--threads", threads, 0, 1024);
}

}  // namespace nerf::synthetic
