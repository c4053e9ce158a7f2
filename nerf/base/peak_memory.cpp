#include "nerf/base/peak_memory.h"

#include <sys/resource.h>

namespace nerf {

double PeakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024e-6;
}

}  // namespace nerf
