#include "nerf/base/parallel.h"

#include <omp.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace nerf {
namespace {

// 0: not set yet. Stored here because LibTorch changes omp_get_max_threads() when it is
// initialised.
std::atomic<int> num_threads = 0;

// Keeps the first exception of several threads.
class FirstFailure {
 public:
  template <class F>
  void Guard(F&& f) {
    try {
      f();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      happened_ = true;
    }
  }
  bool Happened() const { return happened_; }
  void Rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::exception_ptr failure_;
  std::atomic<bool> happened_ = false;
  std::mutex mutex_;
};

#if defined(__SANITIZE_THREAD__)
// The thread sanitizer does not see the synchronisation inside GCC's OpenMP, but that of plain
// threads.
template <class F>
void OnThreads(std::int64_t count, int threads, F&& f) {
  std::atomic<std::int64_t> next = 0;
  const auto run = [&] {
    for (std::int64_t item = next++; item < count; item = next++) f(item);
  };
  std::vector<std::jthread> others;
  for (int t = 1; t < threads; ++t) others.emplace_back(run);
  run();
}
#else
// Calls f(item) for items 0 ... count - 1, scheduled dynamically. With at most one item per thread,
// the same thread always gets the same item, whose data may still be in its cache.
template <class F>
void OnThreads(std::int64_t count, int threads, F&& f) {
  if (count <= threads) {
#pragma omp parallel for schedule(static, 1) num_threads(threads)
    for (std::int64_t item = 0; item < count; ++item) f(item);
  } else {
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (std::int64_t item = 0; item < count; ++item) f(item);
  }
}
#endif

}  // namespace

std::optional<double> ReadCpuQuota(const std::filesystem::path& cpu_max) {
  std::ifstream file(cpu_max);
  std::string quota;
  double period = 0;
  if (!(file >> quota >> period) || quota == "max" || !(period > 0)) return std::nullopt;
  const double cores = std::strtod(quota.c_str(), nullptr) / period;
  return cores > 0 ? std::optional(cores) : std::nullopt;
}

int CoresWithinQuota(int cores, std::optional<double> quota) {
  if (quota && *quota < cores) cores = static_cast<int>(std::ceil(*quota));
  return std::max(1, cores);
}

int AvailableCores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  const int cores = sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : 1;
  return CoresWithinQuota(cores, ReadCpuQuota("/sys/fs/cgroup/cpu.max"));
}

void SetNumThreads(int threads) {
  num_threads = std::max(1, threads);
  omp_set_num_threads(num_threads);
}

int NumThreads() { return num_threads > 0 ? num_threads.load() : AvailableCores(); }

void ParallelFor(std::int64_t count, std::int64_t grain,
                 const std::function<void(std::int64_t, std::int64_t)>& body) {
  if (count <= 0) return;
  const std::int64_t most = (count + grain - 1) / std::max<std::int64_t>(1, grain);
  const std::int64_t chunks = std::min<std::int64_t>(NumThreads(), most);
  if (chunks <= 1) {
    body(0, count);
    return;
  }
  FirstFailure failure;
  OnThreads(chunks, static_cast<int>(chunks), [&](std::int64_t k) {
    failure.Guard([&] { body(count * k / chunks, count * (k + 1) / chunks); });
  });
  failure.Rethrow();
}

void ParallelForEach(std::int64_t count, const std::function<void(std::int64_t)>& body,
                     int threads) {
  if (threads <= 0) threads = NumThreads();
  FirstFailure failure;
  OnThreads(count, static_cast<int>(std::clamp<std::int64_t>(count, 1, threads)),
            [&](std::int64_t item) {
              if (!failure.Happened()) failure.Guard([&] { body(item); });
            });
  failure.Rethrow();
}

}  // namespace nerf
