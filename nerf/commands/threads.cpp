#include "nerf/commands/threads.h"

#include <ATen/Parallel.h>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"

namespace nerf {

int UseThreads(int threads) {
  if (threads < 0) {
    throw InputError("--threads {}: use 1 or more, or 0 for all cores", threads);
  }
  // Set explicitly, because LibTorch's default can be one thread on a machine with two cores.
  const int used = threads > 0 ? threads : AvailableCores();
  SetNumThreads(used);
  at::set_num_threads(used);
  return used;
}

}  // namespace nerf
