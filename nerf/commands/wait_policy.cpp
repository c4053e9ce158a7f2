// Sets how OpenMP threads wait for each other. By default GCC's library lets them spin for
// milliseconds, which is fastest on an idle machine and very slow on a busy one: two trainings on
// two cores took four times as long as one. With a short spin a single training is as fast, and the
// processor is soon free for others. The library reads its settings when it is loaded, before main;
// so this code runs before the initialisation of any library, and restarts the program with the
// setting in its environment. OMP_WAIT_POLICY and GOMP_SPINCOUNT in the environment take
// precedence.
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
  // Under its own path, after which the system names the process.
  char program[4096];
  const ssize_t length = readlink("/proc/self/exe", program, sizeof(program) - 1);
  if (length <= 0) return;
  program[length] = '\0';
  execve(program, argv, with_setting);
  // If that fails, the program continues with the default.
}

[[gnu::used, gnu::section(".preinit_array")]] void (*const run_before_libraries)(
    int, char**, char**) = &RestartWithShortWaits;

}  // namespace

#endif
