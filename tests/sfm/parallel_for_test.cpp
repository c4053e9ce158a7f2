#include "sfm/parallel_for.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace sfm {
namespace {

TEST(ParallelFor, DoesEveryItemOnce) {
  for (const int threads : {0, 1, 3, 50}) {
    std::vector<std::atomic<int>> done(20);
    ParallelFor(20, threads, [&](int i) { ++done[i]; });
    for (const auto& count : done) EXPECT_EQ(count, 1) << threads;
  }
  ParallelFor(0, 2, [](int) { FAIL(); });
}

TEST(ParallelFor, HandsTheExceptionOn) {
  EXPECT_THROW(ParallelFor(100, 2,
                           [](int i) {
                             if (i == 7) throw std::runtime_error("7");
                           }),
               std::runtime_error);
}

}  // namespace
}  // namespace sfm
