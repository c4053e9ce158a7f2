#include "nerf/study/pareto.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace nerf {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(ParetoFront, LeavesOutWhatAnotherBeats) {
  const std::vector<Offer> offers = {{3, 30}, {1, 20}, {2, 19}, {4, 30}, {5, 31}, {1, 18}};
  EXPECT_THAT(ParetoFront(offers), ElementsAre(1, 0, 4));
}

TEST(ParetoFront, EqualOffersStandBesideEachOther) {
  const std::vector<Offer> offers = {{1, 20}, {1, 20}};
  EXPECT_THAT(ParetoFront(offers), ElementsAre(0, 1));
}

TEST(ParetoFront, NothingAndWhatIsNoNumberIsOnNone) {
  EXPECT_THAT(ParetoFront({}), IsEmpty());
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<Offer> offers = {{1, inf}, {inf, 1}, {std::nan(""), 1}, {1, 1}};
  EXPECT_THAT(ParetoFront(offers), ElementsAre(3));
}

TEST(ParetoFront, IsWhatComparingAllWithAllFinds) {
  std::mt19937 generator(3);
  std::uniform_int_distribution<int> draw(0, 9);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Offer> offers(12);
    for (Offer& offer : offers) offer = {double(draw(generator)), double(draw(generator))};
    std::vector<std::size_t> found = ParetoFront(offers), expected;
    for (std::size_t i = 0; i < offers.size(); ++i) {
      bool beaten = false;
      for (const Offer& other : offers) {
        const bool as_good = other.cost <= offers[i].cost && other.value >= offers[i].value;
        beaten |= as_good && (other.cost < offers[i].cost || other.value > offers[i].value);
      }
      if (!beaten) expected.push_back(i);
    }
    for (std::size_t i = 1; i < found.size(); ++i) {
      EXPECT_LE(offers[found[i - 1]].cost, offers[found[i]].cost);
      EXPECT_LE(offers[found[i - 1]].value, offers[found[i]].value);
    }
    std::ranges::sort(found);
    EXPECT_EQ(found, expected);
  }
}

}  // namespace
}  // namespace nerf
