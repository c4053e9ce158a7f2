#include "nerf/base/parallel.h"

#include <gtest/gtest.h>

#include <optional>
#include <stdexcept>
#include <vector>

#include "tests/support/scratch_folder.h"

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

TEST(ParallelFor, DoesNothingForZeroItems) {
  ParallelFor(0, 1, [](std::int64_t, std::int64_t) { FAIL(); });
}

TEST(ParallelFor, RethrowsAnException) {
  EXPECT_THROW(
      ParallelFor(100, 1, [](std::int64_t, std::int64_t) { throw std::logic_error("no"); }),
      std::logic_error);
}

TEST(ParallelForEach, VisitsEveryItemOnceAndRethrowsAnException) {
  std::vector<int> visits(100, 0);
  ParallelForEach(
      100, [&](std::int64_t i) { ++visits[i]; }, 3);
  EXPECT_EQ(visits, std::vector<int>(100, 1));
  EXPECT_THROW(ParallelForEach(10, [](std::int64_t) { throw std::logic_error("no"); }),
               std::logic_error);
}

TEST(CpuQuota, IsReadInCores) {
  const test::ScratchFolder folder;
  const auto quota_of = [&](const char* text) {
    return ReadCpuQuota(folder.Write("cpu.max", text));
  };
  EXPECT_EQ(quota_of("200000 100000\n"), 2.0);
  EXPECT_EQ(quota_of("150000 100000\n"), 1.5);
  EXPECT_EQ(quota_of("50000 100000\n"), 0.5);
}

TEST(CpuQuota, IsAbsentWithoutALimitOrAValidFile) {
  const test::ScratchFolder folder;
  EXPECT_EQ(ReadCpuQuota(folder.path() / "absent"), std::nullopt);
  for (const char* text : {"max 100000\n", "", "200000", "200000 0\n", "0 100000\n", "-1 100000\n",
                           "many 100000\n", "200000 soon\n"}) {
    EXPECT_EQ(ReadCpuQuota(folder.Write("cpu.max", text)), std::nullopt) << text;
  }
}

TEST(CpuQuota, IsRoundedUpAndLimitsTheCores) {
  EXPECT_EQ(CoresWithinQuota(8, std::nullopt), 8);
  EXPECT_EQ(CoresWithinQuota(8, 2.0), 2);
  EXPECT_EQ(CoresWithinQuota(8, 1.5), 2);
  EXPECT_EQ(CoresWithinQuota(8, 7.01), 8);
  EXPECT_EQ(CoresWithinQuota(8, 64.0), 8);
  EXPECT_EQ(CoresWithinQuota(8, 1e30), 8);
  EXPECT_EQ(CoresWithinQuota(8, 0.1), 1);
  EXPECT_EQ(CoresWithinQuota(0, std::nullopt), 1);
}

}  // namespace
}  // namespace nerf
