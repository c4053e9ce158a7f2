#include "nerf/train/held_out.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace nerf {
namespace {

Dataset Photographs(int train, int validation) {
  Dataset data;
  for (int i = 0; i < train + validation; ++i) {
    View view;
    view.name = std::to_string(i);
    view.normalized_from_camera = Eigen::Isometry3d::Identity();
    (i < train ? data.train : data.validation).push_back(view);
  }
  return data;
}

std::vector<std::string> NamesOf(const std::vector<View>& views) {
  std::vector<std::string> names;
  for (const View& view : views) names.push_back(view.name);
  return names;
}

TEST(HeldOut, AreForValidationMeanwhileAndInTheirPlacesAgainAfterwards) {
  Dataset data = Photographs(40, 1);
  const std::vector<std::string> before = NamesOf(data.train);
  SceneFacts scene = FactsOf(data, {});
  scene.exposure_stops.assign(40, 0.5);
  {
    const HeldOut held_out(data, scene);
    EXPECT_EQ(data.validation.size(), 4u);
    EXPECT_EQ(data.train.size(), 37u);
    EXPECT_EQ(NamesOf(data.train), held_out.Scene().photographs);
    EXPECT_EQ(held_out.Scene().places.size(), 37u);
    EXPECT_EQ(held_out.Scene().exposure_stops.size(), 37u);
    for (const View& view : data.validation) {
      EXPECT_EQ(std::ranges::count(NamesOf(data.train), view.name), 0) << view.name;
    }
  }
  EXPECT_EQ(NamesOf(data.train), before);
  EXPECT_EQ(NamesOf(data.validation), std::vector<std::string>{"40"});
}

TEST(HeldOut, AreNoneWhereThereAreEnoughOrTooFew) {
  for (const auto& [train, validation] : {std::pair(40, 4), std::pair(7, 0)}) {
    Dataset data = Photographs(train, validation);
    const HeldOut held_out(data, FactsOf(data, {}));
    EXPECT_EQ(data.train.size(), static_cast<std::size_t>(train));
    EXPECT_EQ(held_out.Scene().photographs.size(), static_cast<std::size_t>(train));
  }
}

}  // namespace
}  // namespace nerf
