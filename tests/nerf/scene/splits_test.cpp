#include "nerf/scene/splits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/numbered_images.h"

namespace nerf {
namespace {

using test::NumberedImages;

std::vector<int> IndicesOf(const PosedImages& posed, Split split) {
  std::vector<int> indices;
  for (std::size_t i = 0; i < posed.images.size(); ++i) {
    if (posed.images[i].split == split) indices.push_back(static_cast<int>(i));
  }
  return indices;
}

TEST(AssignSplits, EveryEighthImageByNameIsHeldOut) {
  PosedImages posed = NumberedImages(50);
  std::ranges::reverse(posed.images);  // the order of the images does not matter
  AssignSplits(posed, DataOptions());
  std::ranges::reverse(posed.images);
  EXPECT_EQ(IndicesOf(posed, Split::kTest), (std::vector<int>{0, 8, 16, 24, 32, 40, 48}));
  EXPECT_EQ(IndicesOf(posed, Split::kValidation).size(), 3u);
  EXPECT_EQ(IndicesOf(posed, Split::kTrain).size(), 40u);
}

TEST(AssignSplits, ATestSplitOfTheSourceIsKept) {
  PosedImages posed = NumberedImages(40);
  posed.images[3].split = Split::kTest;
  AssignSplits(posed, DataOptions());
  EXPECT_EQ(IndicesOf(posed, Split::kTest), (std::vector<int>{3}));
}

TEST(AssignSplits, FewImagesAreAllTrainedOn) {
  PosedImages posed = NumberedImages(2);
  AssignSplits(posed, DataOptions());
  EXPECT_EQ(IndicesOf(posed, Split::kTrain).size(), 2u);
}

TEST(AssignSplits, AValidationSplitOfTheSourceIsKept) {
  PosedImages posed = NumberedImages(40);
  posed.images[5].split = Split::kValidation;
  AssignSplits(posed, DataOptions());
  EXPECT_EQ(IndicesOf(posed, Split::kValidation), (std::vector<int>{5}));
}

TEST(AssignSplits, NothingIsHeldOutWithTestEveryZero) {
  PosedImages posed = NumberedImages(40);
  DataOptions options;
  options.test_every = 0;
  options.validation_images = 0;
  AssignSplits(posed, options);
  EXPECT_EQ(IndicesOf(posed, Split::kTrain).size(), 40u);
}

}  // namespace
}  // namespace nerf
