#include "nerf/base/input_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace nerf {
namespace {

TEST(InputError, IsOneLineWhateverTheNamesInIt) {
  EXPECT_STREQ(InputError("a.json: key {} is unknown", "x\ny\x1b[31m").what(),
               "a.json: key x y [31m is unknown");
  EXPECT_STREQ(InputError(std::string("two\r\nlines")).what(), "two  lines");
}

TEST(InputError, KeepsUtf8AndShortensLongMessages) {
  EXPECT_STREQ(InputError("Füchse/{}", "ä.jpg").what(), "Füchse/ä.jpg");
  EXPECT_STREQ(InputError("a\xc2\x9b[31m").what(), "a  [31m");
  std::string name;
  for (int i = 0; i < 100000; ++i) name += "ä";
  const std::string cut = InputError("a.json: {}; rename it", name).what();
  EXPECT_LT(cut.size(), 2000u);
  EXPECT_THAT(cut,
              testing::AllOf(testing::StartsWith("a.json: ä"), testing::EndsWith("ä; rename it"),
                             testing::HasSubstr("ä ... ä")));
}

}  // namespace
}  // namespace nerf
