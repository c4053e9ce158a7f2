#include "nerf/scene/data_options.h"

#include "nerf/base/input_error.h"

namespace nerf {

void DataOptions::Check() const {
  if (downscale < 1) throw InputError("config: data.downscale is {}; use 1 or more", downscale);
  if (test_every < 0 || test_every == 1) {
    throw InputError("config: data.test_every is {}; use 2 or more, or 0 to hold out none",
                     test_every);
  }
  if (validation_images < 0) {
    throw InputError("config: data.validation_images is {}; use 0 or more", validation_images);
  }
  if (memory_mb < 1) throw InputError("config: data.memory_mb is {}; use 1 or more", memory_mb);
}

}  // namespace nerf
