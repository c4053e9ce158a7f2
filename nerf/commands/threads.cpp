#include "nerf/commands/threads.h"

#include <ATen/Parallel.h>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"

namespace nerf {

int UseThreads(int threads) {
  if (threads < 0) {
    throw InputError("--threads {}: use 1 or more, or 0 for all cores", threads);
  }
  // LibTorch's own default has been seen to be one thread on a machine with two.
  const int used = threads > 0 ? threads : AvailableCores();
  SetNumThreads(used);
  at::set_num_threads(used);
  return used;
}

}  // namespace nerf
