#include "sfm/input_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sfm {
namespace {

TEST(InputError, StaysOnOneLineWhateverTheNamesInIt) {
  EXPECT_STREQ(InputError("a.json: key {} is unknown", "x\ny\x1b[31m").what(),
               "a.json: key x y [31m is unknown");
  EXPECT_STREQ(InputError(std::string("two\r\nlines")).what(), "two  lines");
}

TEST(InputError, KeepsUtf8AndCutsWhatNobodyReads) {
  EXPECT_STREQ(InputError("Füchse/{}", "ä.jpg").what(), "Füchse/ä.jpg");
  EXPECT_LT(std::string(InputError("{}", std::string(1 << 20, 'x')).what()).size(), 2010u);
}

}  // namespace
}  // namespace sfm
