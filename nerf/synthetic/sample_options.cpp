#include "nerf/synthetic/sample_options.h"

#include <string_view>

#include "nerf/base/input_error.h"

namespace nerf::sample {
namespace {

void CheckRange(std::string_view flag, int value, int lowest, int highest) {
  if (value >= lowest && value <= highest) return;
  throw InputError("{} is {}: choose a number from {} to {}", flag, value, lowest, highest);
}

}  // namespace

void SampleOptions::Check() const {
  CheckRange("--views", views, 2, 1000);
  CheckRange("--width", width, 1, 8192);
  CheckRange("--height", height, 1, 8192);
  CheckRange("--samples", samples_per_pixel, 1, 1024);
  CheckRange("--threads", threads, 0, 1024);
}

}  // namespace nerf::sample
