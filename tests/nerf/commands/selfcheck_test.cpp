#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "nerf/kernels/simd_level.h"
#include "tests/nerf/commands/run_program.h"

namespace nerf {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(SelfcheckCommand, PrintsALinePerCaseAndPasses) {
  const auto result = test::RunNerf("selfcheck");
  EXPECT_EQ(result.exit_status, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("ThinFogKeepsItsOpacity"));
  EXPECT_THAT(result.output, HasSubstr("BothEnginesAgree"));
  EXPECT_THAT(result.output, Not(HasSubstr("FAIL")));
  // The default SIMD level has a column.
  EXPECT_THAT(result.output, HasSubstr(kernels::SimdLevels().front().name));
}

TEST(SelfcheckCommand, JsonHasARowForEachLevel) {
  const auto result = test::RunNerf("selfcheck --json");
  ASSERT_EQ(result.exit_status, 0) << result.output;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_TRUE(json.at("passed"));
  int levels = 0;
  for (const auto& row : json.at("cases")) {
    EXPECT_TRUE(row.at("passed")) << row;
    EXPECT_LE(row.at("error"), row.at("bound")) << row;
    levels += row.at("case") == "NetworksMatchPlainLoops";
  }
  EXPECT_GE(levels, 1);
}

TEST(SelfcheckCommand, RejectsAnUnknownFlag) {
  EXPECT_EQ(test::RunNerf("selfcheck --quick").exit_status, 2);
}

}  // namespace
}  // namespace nerf
