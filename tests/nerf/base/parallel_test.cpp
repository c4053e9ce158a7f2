#include "nerf/base/parallel.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace nerf {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnce) {
  for (const int threads : {1, 2, 5}) {
    SetNumThreads(threads);
    std::vector<int> visits(1000, 0);
    ParallelFor(1000, 1, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_EQ(visits, std::vector<int>(1000, 1));
  }
  SetNumThreads(AvailableCores());
}

TEST(ParallelFor, DoesNothingForNothing) {
  ParallelFor(0, 1, [](std::int64_t, std::int64_t) { FAIL(); });
}

TEST(ParallelFor, HandsOnAnException) {
  EXPECT_THROW(
      ParallelFor(100, 1, [](std::int64_t, std::int64_t) { throw std::logic_error("no"); }),
      std::logic_error);
}

}  // namespace
}  // namespace nerf
