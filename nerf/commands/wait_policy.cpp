// How OpenMP's threads wait for each other. By default GCC's library lets them spin for
// milliseconds, which is the fastest while nobody else needs the processor, and very slow where
// somebody does: two trainings on two cores took four times as long as one. A short spin keeps a
// training alone as fast, and gives the processor away soon. The library reads its settings once,
// when it is loaded, before main: so this runs before any library's initialisation and starts the
// program anew with them in its environment. Whoever sets OMP_WAIT_POLICY or GOMP_SPINCOUNT decides
// for himself.
#include <alloca.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>

#if !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__) && defined(__linux__)

namespace {

// About 20 microseconds; docs/benchmarks.md has the measurement.
constexpr char kSpinCount[] = "GOMP_SPINCOUNT=10000";

// No library is initialised yet: system calls only.
void RestartWithShortWaits(int, char** argv, char** environment) {
  std::size_t count = 0;
  for (; environment[count] != nullptr; ++count) {
    if (std::strncmp(environment[count], "OMP_WAIT_POLICY=", 16) == 0) return;
    if (std::strncmp(environment[count], "GOMP_SPINCOUNT=", 15) == 0) return;
  }
  auto** const with_setting = static_cast<char**>(alloca((count + 2) * sizeof(char*)));
  std::memcpy(with_setting, environment, count * sizeof(char*));
  with_setting[count] = const_cast<char*>(kSpinCount);
  with_setting[count + 1] = nullptr;
  execve("/proc/self/exe", argv, with_setting);
  // Where that fails the program goes on as it is.
}

[[gnu::used, gnu::section(".preinit_array")]] void (*const run_before_libraries)(
    int, char**, char**) = &RestartWithShortWaits;

}  // namespace

#endif
