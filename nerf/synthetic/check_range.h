#pragma once

#include <string_view>

#include "nerf/base/input_error.h"

namespace nerf::synthetic {

// Throws InputError, naming the flag, if a value is outside [lowest, highest].
inline void CheckRange(std::string_view flag, int value, int lowest, int highest) {
  if (value >= lowest && value <= highest) return;
  throw InputError("{} is {}: choose a number from {} to {}", flag, value, lowest, highest);
}

}  // namespace nerf::synthetic
