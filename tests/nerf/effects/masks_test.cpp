#include "nerf/effects/masks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nerf/config/config.h"
#include "tests/support/input_error_of.h"

namespace nerf {
namespace {

TEST(MasksEffect, RejectsAnUnknownMeaning) {
  EXPECT_THAT(
      test::InputErrorOf([] { LoadConfig("base", {R"(effects.masks={"meaning": "sky"})"}); }),
      testing::AllOf(testing::HasSubstr("effects.masks.meaning"), testing::HasSubstr("sky"),
                     testing::HasSubstr("ignore, empty")));
}

TEST(MasksEffect, HasNoMeaningWhereItIsOff) { EXPECT_EQ(MeaningOf(std::nullopt), std::nullopt); }

TEST(MasksEffect, HasTheConfiguredMeaning) {
  EXPECT_EQ(MeaningOf(MaskOptions{MaskMeaning::kIgnore}), MaskMeaning::kIgnore);
  EXPECT_EQ(MeaningOf(MaskOptions{MaskMeaning::kEmpty}), MaskMeaning::kEmpty);
  EXPECT_EQ(MeaningOf(MaskOptions()), MaskMeaning::kIgnore);  // as COLMAP's masks
}

}  // namespace
}  // namespace nerf
