#include "nerf/base/options.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace nerf {
namespace {

TEST(Range, ContainsItsEndsUnlessTheyAreOpen) {
  EXPECT_TRUE(Between(1, 3).Contains(1));
  EXPECT_TRUE(Between(1, 3).Contains(3));
  EXPECT_FALSE(Between(1, 3).Contains(3.1));
  EXPECT_FALSE(Above(0).Contains(0));
  EXPECT_TRUE(AtLeast(0).Contains(0));
  EXPECT_FALSE(StrictlyBetween(0, 1).Contains(1));
  EXPECT_FALSE(AboveUpTo(0, 1).Contains(0));
  EXPECT_TRUE(AboveUpTo(0, 1).Contains(1));
  EXPECT_TRUE(ZeroOr(Between(1, 5)).Contains(0));
  EXPECT_FALSE(ZeroOr(Between(1, 5)).Contains(0.5));
  EXPECT_TRUE(OneOf({1, 2, 4}).Contains(2));
  EXPECT_FALSE(OneOf({1, 2, 4}).Contains(3));
}

TEST(Range, ContainsNothingThatIsNotFinite) {
  for (const Range& range : {Range{}, AtLeast(0), Between(0, 1)}) {
    EXPECT_FALSE(range.Contains(std::nan("")));
    EXPECT_FALSE(range.Contains(std::numeric_limits<double>::infinity()));
  }
}

TEST(Range, IsReadableByPeople) {
  EXPECT_EQ(Between(1, 32).Text(), "1 to 32");
  EXPECT_EQ(AtLeast(0).Text(), "0 or more");
  EXPECT_EQ(Above(0).Text(), "above 0");
  EXPECT_EQ(AboveUpTo(0, 1e6).Text(), "above 0, at most 1000000");
  EXPECT_EQ(StrictlyBetween(0, 1).Text(), "between 0 and 1, exclusive");
  EXPECT_EQ(ZeroOr(AtLeast(2)).Text(), "0 or 2 or more");
  EXPECT_EQ(OneOf({1, 2, 4, 8}).Text(), "1, 2, 4 or 8");
}

}  // namespace
}  // namespace nerf
