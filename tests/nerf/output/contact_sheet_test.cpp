#include "nerf/output/contact_sheet.h"

#include <gtest/gtest.h>

#include <vector>

#include "nerf/base/input_error.h"
#include "tests/support/constant_image.h"

namespace nerf {
namespace {

using test::ConstantImage;

// Number of pixels of a grey value.
int Count(const Image& image, float value) {
  int count = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    count +=
        image.pixels[i] == value && image.pixels[i + 1] == value && image.pixels[i + 2] == value;
  }
  return count;
}

TEST(ContactSheet, ContainsTruthRenderingAndDifference) {
  const std::vector<ContactSheetRow> rows = {
      {"", ConstantImage(30, 20, 3, 0.25f), ConstantImage(30, 20, 3, 0.25f)}};
  const Image sheet = ContactSheet(rows);
  ASSERT_EQ(sheet.channels, 3);
  EXPECT_EQ(sheet.encoding, ColorEncoding::kSrgb);
  EXPECT_EQ(Count(sheet, 0.25f), 2 * 30 * 20);
  EXPECT_EQ(Count(sheet, 0.0f), 30 * 20);
  EXPECT_EQ(Count(sheet, 1.0f), sheet.width * sheet.height - 3 * 30 * 20);
}

TEST(ContactSheet, StacksRowsOfDifferentSizes) {
  const std::vector<ContactSheetRow> rows = {
      {"", ConstantImage(30, 20, 3, 0.25f), ConstantImage(30, 20, 3, 0.5f)},
      {"", ConstantImage(50, 10, 3, 0.75f), ConstantImage(50, 10, 3, 0.5f)}};
  const Image sheet = ContactSheet(rows);
  EXPECT_EQ(Count(sheet, 0.25f), 600);
  EXPECT_EQ(Count(sheet, 0.75f), 500);
  EXPECT_EQ(Count(sheet, 0.5f), 1100);
}

TEST(ContactSheet, ReducesLargePicturesToTwoThousandPixels) {
  const std::vector<ContactSheetRow> rows = {
      {"", ConstantImage(1500, 40, 3, 0.25f), ConstantImage(1500, 40, 3, 0.25f)}};
  const Image sheet = ContactSheet(rows);
  EXPECT_LE(sheet.width, 2000);
  EXPECT_GT(sheet.width, 1500);
}

TEST(ContactSheet, CompositesAlphaOverWhite) {
  const std::vector<ContactSheetRow> rows = {
      {"", ConstantImage(9, 9, 4, 0.5f), ConstantImage(9, 9, 3, 0.75f)}};
  EXPECT_EQ(Count(ContactSheet(rows), 0.75f), 2 * 81);
}

TEST(ContactSheet, CaptionsDoNotOverlapThePictures) {
  std::vector<ContactSheetRow> rows = {
      {"r_8.png  31.42 dB", ConstantImage(90, 20, 3, 0.25f), ConstantImage(90, 20, 3, 0.25f)}};
  EXPECT_EQ(Count(ContactSheet(rows), 0.25f), 2 * 90 * 20);
}

TEST(ContactSheet, WithoutRowsIsEmpty) { EXPECT_TRUE(ContactSheet({}).pixels.empty()); }

TEST(ContactSheet, RejectsPicturesOfDifferentSizes) {
  const std::vector<ContactSheetRow> rows = {{"", Image(3, 4, 3), Image(4, 3, 3)}};
  EXPECT_THROW(ContactSheet(rows), InputError);
}

}  // namespace
}  // namespace nerf
