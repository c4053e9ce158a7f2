#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

namespace nerf {

// Number of cores that this process may use: those of the affinity mask, at most the CPU quota of
// the cgroup, rounded up.
int AvailableCores();

// Reads the CPU quota of cgroup v2 from a file such as /sys/fs/cgroup/cpu.max, "QUOTA PERIOD" in
// microseconds.
//   returns  in cores; nullopt where there is no quota ("max"), no such file, or no valid one
std::optional<double> ReadCpuQuota(const std::filesystem::path& cpu_max);

// `cores`, but at most the quota rounded up; at least 1.
int CoresWithinQuota(int cores, std::optional<double> quota);

// Number of threads of ParallelFor; all available cores by default. LibTorch and OpenBLAS share its
// OpenMP pool.
void SetNumThreads(int threads);
int NumThreads();

// Calls body(begin, end) on consecutive chunks of [0, count), one chunk per thread, and waits. The
// chunks depend only on `count`, `grain` and the number of threads, so that results are
// reproducible.
//   grain  smallest size of a chunk
// After all chunks have ended, rethrows the first exception of one.
void ParallelFor(std::int64_t count, std::int64_t grain,
                 const std::function<void(std::int64_t, std::int64_t)>& body);

// Calls body(item) for each item in [0, count), scheduled dynamically, and waits: for items of
// unequal cost whose results do not depend on the thread. After an exception no further items are
// started, and the first one is rethrown.
//   threads  0: NumThreads()
void ParallelForEach(std::int64_t count, const std::function<void(std::int64_t)>& body,
                     int threads = 0);

}  // namespace nerf
