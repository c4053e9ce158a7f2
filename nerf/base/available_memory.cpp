#include "nerf/base/available_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

namespace nerf {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

// The number after a key of a file of lines; 0 where it is missing.
double ValueIn(const char* path, const std::string& wanted) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    double value = 0;
    if (words >> key >> value && key == wanted) return value;
  }
  return 0;
}

double OfSystem() {
  const double kilobytes = ValueIn("/proc/meminfo", "MemAvailable:");
  return kilobytes > 0 ? kilobytes * 1024e-6 : kUnlimited;
}

// The limit of a container (cgroup 2), less what is used and cannot be freed: files that were read
// count as used.
double OfContainer() {
  double limit = 0, used = 0;
  std::ifstream most("/sys/fs/cgroup/memory.max"), current("/sys/fs/cgroup/memory.current");
  if (!(most >> limit) || !(current >> used)) return kUnlimited;  // "max", or no container
  const char* const stat = "/sys/fs/cgroup/memory.stat";
  const double files = ValueIn(stat, "inactive_file") + ValueIn(stat, "active_file");
  return std::max(0.0, limit - used + files) * 1e-6;
}

}  // namespace

double AvailableMegabytes() { return std::min(OfSystem(), OfContainer()); }

}  // namespace nerf
