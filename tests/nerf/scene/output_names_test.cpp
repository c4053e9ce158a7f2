#include "nerf/scene/output_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace nerf {
namespace {

using testing::ElementsAre;

std::vector<std::string> NamesOf(const std::vector<std::string>& images) {
  std::vector<PosedImage> posed;
  for (const std::string& name : images) posed.emplace_back().name = name;
  return OutputNames(posed);
}

TEST(OutputNames, AreThoseOfTheImagesWithoutExtension) {
  EXPECT_THAT(NamesOf({"train/r_0.png", "../images/0001.jpg", "a.b.c.jpg", "plain"}),
              ElementsAre("train_r_0", "images_0001", "a.b.c", "plain"));
}

TEST(OutputNames, OfDifferentImagesAreDifferent) {
  EXPECT_THAT(NamesOf({"0001.jpg", "0001.png", "2.jpg"}), ElementsAre("0001_jpg", "0001_png", "2"));
  EXPECT_THAT(NamesOf({"left/1.jpg", "left_1.jpg"}), ElementsAre("left_1_jpg", "left_1_jpg_2"));
  EXPECT_THAT(NamesOf({"a.jpg", "A.jpg"}), ElementsAre("a_jpg", "A_jpg_2"));
  // The name that would distinguish two images may be that of a third.
  const auto names = NamesOf({"0001.jpg", "0001.png", "0001_jpg.png", "x/0001_jpg", "x_0001/jpg"});
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), 5u);
}

}  // namespace
}  // namespace nerf
