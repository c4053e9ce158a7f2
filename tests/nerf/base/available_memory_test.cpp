#include "nerf/base/available_memory.h"

#include <gtest/gtest.h>

namespace nerf {
namespace {

// Megabytes, neither bytes nor kilobytes: a test runs with 50 MB to spare on no more than 16 TB.
TEST(AvailableMegabytes, AreOfThisMachine) {
  EXPECT_GT(AvailableMegabytes(), 50);
  EXPECT_LT(AvailableMegabytes(), 16e6);
}

}  // namespace
}  // namespace nerf
