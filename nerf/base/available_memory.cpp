#include "nerf/base/available_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace nerf {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

double OfSystem() {
  std::ifstream file("/proc/meminfo");
  for (std::string key; file >> key;) {
    double kilobytes = 0;
    if (key == "MemAvailable:" && file >> kilobytes) return kilobytes * 1024e-6;
  }
  return kUnlimited;
}

// The limit of a container (cgroup 2), less what is used.
double OfContainer() {
  double limit = 0, used = 0;
  std::ifstream most("/sys/fs/cgroup/memory.max"), current("/sys/fs/cgroup/memory.current");
  if (!(most >> limit) || !(current >> used)) return kUnlimited;  // "max", or no container
  return std::max(0.0, limit - used) * 1e-6;
}

}  // namespace

double AvailableMegabytes() { return std::min(OfSystem(), OfContainer()); }

}  // namespace nerf
