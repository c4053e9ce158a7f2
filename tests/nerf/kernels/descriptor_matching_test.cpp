#include "nerf/kernels/descriptor_matching.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "nerf/reference/descriptor_matching.h"
#include "tests/support/simd_levels.h"

namespace nerf::kernels {
namespace {

std::vector<std::uint8_t> RandomDescriptors(std::size_t count, std::uint32_t seed, int most = 255) {
  std::mt19937 generator(seed);
  std::uniform_int_distribution<int> number(0, most);
  std::vector<std::uint8_t> descriptors(count * kDescriptorSize);
  for (std::uint8_t& d : descriptors) d = static_cast<std::uint8_t>(number(generator));
  return descriptors;
}

class DescriptorMatching : public test::EverySimdLevel {};

void ExpectReference(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  std::vector<NearestTwo> of_a(a.size() / kDescriptorSize), of_b(b.size() / kDescriptorSize);
  FindNearestTwo(a, b, of_a, of_b);
  EXPECT_EQ(of_a, reference::FindNearestTwo(a, b));
  EXPECT_EQ(of_b, reference::FindNearestTwo(b, a));
}

// Counts beside the sizes of blocks, and none at all.
TEST_P(DescriptorMatching, IsExactForEveryCount) {
  std::uint32_t seed = 0;
  for (const std::size_t count_a : {0, 1, 3, 4, 5, 63, 64, 65, 200}) {
    for (const std::size_t count_b : {0, 1, 2, 15, 16, 17, 64, 65, 131}) {
      SCOPED_TRACE(testing::Message() << count_a << " with " << count_b);
      seed += 2;
      ExpectReference(RandomDescriptors(count_a, seed), RandomDescriptors(count_b, seed + 1));
    }
  }
}

// The largest numbers, which 16 bits cannot sum, and zeros, which match nothing.
TEST_P(DescriptorMatching, IsExactAtTheExtremes) {
  std::vector<std::uint8_t> a = RandomDescriptors(9, 1), b = RandomDescriptors(21, 2);
  std::fill_n(&a[3 * kDescriptorSize], kDescriptorSize, std::uint8_t{255});
  std::fill_n(&b[20 * kDescriptorSize], kDescriptorSize, std::uint8_t{255});
  std::fill_n(&a[5 * kDescriptorSize], kDescriptorSize, std::uint8_t{0});
  ExpectReference(a, b);
  std::vector<NearestTwo> of_a(9), of_b(21);
  FindNearestTwo(a, b, of_a, of_b);
  EXPECT_EQ(of_a[3].product, 128 * 255 * 255);
  EXPECT_EQ(of_a[3].index, 20);
  EXPECT_EQ(of_a[5], NearestTwo());
}

// Two that are alike leave no doubt about products: both are as near.
TEST_P(DescriptorMatching, OfTwoAlikeBothCount) {
  const std::vector<std::uint8_t> a = RandomDescriptors(1, 3);
  std::vector<std::uint8_t> b = RandomDescriptors(40, 4, 20);
  for (const std::size_t copy : {7, 33}) std::ranges::copy(a, &b[copy * kDescriptorSize]);
  std::vector<NearestTwo> of_a(1), of_b(40);
  FindNearestTwo(a, b, of_a, of_b);
  EXPECT_EQ(of_a[0].product, of_a[0].second_product);
  EXPECT_TRUE(of_a[0].index == 7 || of_a[0].index == 33);
}

NERF_FOR_EVERY_SIMD_LEVEL(DescriptorMatching);

}  // namespace
}  // namespace nerf::kernels
