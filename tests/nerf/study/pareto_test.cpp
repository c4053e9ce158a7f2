#include "nerf/study/pareto.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace nerf {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(ParetoFront, OmitsDominatedPoints) {
  const std::vector<CostAndValue> points = {{3, 30}, {1, 20}, {2, 19}, {4, 30}, {5, 31}, {1, 18}};
  EXPECT_THAT(ParetoFront(points), ElementsAre(1, 0, 4));
}

TEST(ParetoFront, KeepsEqualPoints) {
  const std::vector<CostAndValue> points = {{1, 20}, {1, 20}};
  EXPECT_THAT(ParetoFront(points), ElementsAre(0, 1));
}

TEST(ParetoFront, OmitsNonFinitePoints) {
  EXPECT_THAT(ParetoFront({}), IsEmpty());
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<CostAndValue> points = {{1, inf}, {inf, 1}, {std::nan(""), 1}, {1, 1}};
  EXPECT_THAT(ParetoFront(points), ElementsAre(3));
}

TEST(ParetoFront, EqualsBruteForce) {
  std::mt19937 generator(3);
  std::uniform_int_distribution<int> draw(0, 9);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<CostAndValue> points(12);
    for (CostAndValue& point : points) point = {double(draw(generator)), double(draw(generator))};
    std::vector<std::size_t> found = ParetoFront(points), expected;
    for (std::size_t i = 0; i < points.size(); ++i) {
      bool dominated = false;
      for (const CostAndValue& other : points) {
        const bool as_good = other.cost <= points[i].cost && other.value >= points[i].value;
        dominated |= as_good && (other.cost < points[i].cost || other.value > points[i].value);
      }
      if (!dominated) expected.push_back(i);
    }
    for (std::size_t i = 1; i < found.size(); ++i) {
      EXPECT_LE(points[found[i - 1]].cost, points[found[i]].cost);
      EXPECT_LE(points[found[i - 1]].value, points[found[i]].value);
    }
    std::ranges::sort(found);
    EXPECT_EQ(found, expected);
  }
}

}  // namespace
}  // namespace nerf
