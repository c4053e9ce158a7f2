#include "nerf/base/quantile.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <span>
#include <vector>

namespace nerf {
namespace {

TEST(Quantile, IsTheValueAtThatShareOfTheSortedValues) {
  std::vector<double> values = {5, 1, 4, 2, 3};
  EXPECT_EQ(Quantile(values, 0), 1);
  EXPECT_EQ(Quantile(values, 0.5), 3);
  EXPECT_EQ(Quantile(values, 0.74), 3);  // rounded down, not interpolated
  EXPECT_EQ(Quantile(values, 0.75), 4);
  EXPECT_EQ(Quantile(values, 1), 5);
}

TEST(Quantile, OfNoValuesIsZero) {
  EXPECT_EQ(Quantile(std::vector<double>{}, 0.5), 0);
  EXPECT_EQ(UpperMedian(std::span<float>{}), 0);
  EXPECT_EQ(Median(std::span<float>{}), 0);
}

TEST(UpperMedian, IsTheUpperOfTwoMiddleValues) {
  EXPECT_EQ(UpperMedian(std::vector<float>{7}), 7);
  EXPECT_EQ(UpperMedian(std::vector<float>{4, 1, 3, 2}), 3);
  EXPECT_EQ(UpperMedian(std::array{9, 1, 5}), 5);
}

TEST(Median, IsTheMeanOfTwoMiddleValues) {
  EXPECT_EQ(Median(std::vector<float>{7}), 7);
  EXPECT_EQ(Median(std::vector<float>{4, 1, 3, 2}), 2.5f);
  EXPECT_EQ(Median(std::array{9, 1, 5}), 5);
}

TEST(ValueOfRank, AgreesWithSorting) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> value(0, 20);  // with ties
  for (std::size_t count = 1; count < 40; ++count) {
    std::vector<int> values(count);
    for (int& v : values) v = value(random);
    std::vector<int> sorted = values;
    std::ranges::sort(sorted);
    for (std::size_t rank = 0; rank < count; ++rank) {
      EXPECT_EQ(ValueOfRank(values, rank), sorted[rank]);
    }
  }
}

}  // namespace
}  // namespace nerf
