#include "nerf/study/study_plan.h"

#include <gtest/gtest.h>

#include <set>

#include "nerf/config/config.h"

namespace nerf {
namespace {

TEST(StudySettings, AreValidConfigurationsWithUniqueNames) {
  std::set<std::string> names;
  double share = 0;
  for (const StudySetting& setting : StudySettings(2)) {
    EXPECT_TRUE(names.insert(setting.name).second) << setting.name;
    EXPECT_NO_THROW(LoadConfig(setting.preset, setting.assignments)) << setting.name;
    EXPECT_GE(setting.share, share) << setting.name;  // by increasing time
    share = setting.share;
  }
  EXPECT_GE(names.size(), 10u);
}

TEST(SecondsOfSetting, DivideTheRemainingTime) {
  const std::vector<StudySetting> settings = {{"a", "fast", {}, 1}, {"b", "fast", {}, 3}};
  EXPECT_DOUBLE_EQ(SecondsOfSetting(settings, 0, 100, 10), 20);
  EXPECT_DOUBLE_EQ(SecondsOfSetting(settings, 1, 70, 10), 60);  // the first was as planned
  EXPECT_DOUBLE_EQ(SecondsOfSetting(settings, 1, 40, 10), 30);  // the first took too long
  EXPECT_DOUBLE_EQ(SecondsOfSetting(settings, 1, -5, 10), 1);   // the minimum
}

}  // namespace
}  // namespace nerf
