#pragma once

#include <cstdint>
#include <functional>

namespace nerf {

// Cores this process may use: the affinity mask, and the cgroup's CPU quota rounded up.
int AvailableCores();

// Number of threads that ParallelFor uses. LibTorch and OpenBLAS share the same OpenMP pool.
void SetNumThreads(int threads);
int NumThreads();

// Calls body(begin, end) on consecutive chunks of [0, count), one chunk a thread, and waits. The
// cut depends on `count`, `grain` and the number of threads alone, so results repeat.
//   grain  smallest chunk worth a thread
// The first exception in a chunk is rethrown here after all have ended.
void ParallelFor(std::int64_t count, std::int64_t grain,
                 const std::function<void(std::int64_t, std::int64_t)>& body);

// Calls body(item) for each item in [0, count), whichever thread is free taking the next, and
// waits: for items of unequal cost whose results do not depend on who computes them. After an
// exception no further items are begun.
//   threads  0: NumThreads()
void ParallelForEach(std::int64_t count, const std::function<void(std::int64_t)>& body,
                     int threads = 0);

}  // namespace nerf
