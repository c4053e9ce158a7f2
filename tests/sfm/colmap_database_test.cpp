#include "sfm/colmap_database.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/colmap_database_file.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf::sfm {
namespace {

using nerf::test::InputErrorOf;
using nerf::test::ScratchFolder;
using nerf::test::WriteColmapDatabase;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

TEST(CopyLargestFeatures, KeepsThemWithTheirDescriptorsAndRemovesMatches) {
  const ScratchFolder folder;
  const auto full = folder.path() / "full.db", coarse = folder.path() / "coarse.db";
  WriteColmapDatabase(full, {{"a.jpg", {1, 5, 2, 4, 3}}, {"b.jpg", {7}}, {"c.jpg", {}}},
                      {{0, 1, 40}});
  CopyLargestFeatures(full, coarse, 3);
  EXPECT_TRUE(ReadMatchedPairs(coarse).empty());
  EXPECT_EQ(ReadMatchedPairs(full).size(), 1u);  // as it was
  SQLite::Database read(coarse.string());
  SQLite::Statement a(read,
                      "SELECT keypoints.rows, keypoints.data, descriptors.rows, "
                      "descriptors.data FROM keypoints JOIN descriptors USING (image_id) "
                      "WHERE image_id = 1");
  ASSERT_TRUE(a.executeStep());
  EXPECT_EQ(a.getColumn(0).getInt(), 3);
  EXPECT_EQ(a.getColumn(2).getInt(), 3);
  const auto* keypoints = static_cast<const float*>(a.getColumn(1).getBlob());
  const auto* descriptors = static_cast<const char*>(a.getColumn(3).getBlob());
  ASSERT_EQ(a.getColumn(1).getBytes(), 3 * 6 * 4);
  ASSERT_EQ(a.getColumn(3).getBytes(), 3 * 128);
  const int kept[] = {1, 3, 4};
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(keypoints[6 * k], static_cast<float>(kept[k]));
    EXPECT_EQ(descriptors[128 * k + 127], kept[k]);
  }
  EXPECT_EQ(read.execAndGet("SELECT rows FROM keypoints WHERE image_id = 2").getInt(), 1);
}

TEST(CopyLargestFeatures, ADamagedDatabaseIsNamedWithTheFix) {
  const ScratchFolder folder;
  const auto full = folder.path() / "full.db";
  folder.Write("full.db", "this is no database, but long enough to look at");
  EXPECT_THAT(InputErrorOf([&] { CopyLargestFeatures(full, folder.path() / "coarse.db", 3); }),
              testing::AllOf(HasSubstr("full.db"), HasSubstr("remove it")));
  WriteColmapDatabase(full, {{"a.jpg", {1, 5, 2}}});
  SQLite::Database(full.string(), SQLite::OPEN_READWRITE).exec("UPDATE keypoints SET rows = 900");
  EXPECT_THAT(InputErrorOf([&] { CopyLargestFeatures(full, folder.path() / "coarse.db", 3); }),
              HasSubstr("differ in number"));
}

// Computing features and matches takes hours, so the message must not suggest removing them.
TEST(CopyLargestFeatures, ALockedDatabaseIsNotToBeRemoved) {
  const ScratchFolder folder;
  const auto full = folder.path() / "full.db";
  WriteColmapDatabase(full, {{"a.jpg", {1, 5, 2}}});
  SQLite::Database other(full.string(), SQLite::OPEN_READWRITE);
  other.exec("BEGIN EXCLUSIVE");
  EXPECT_THAT(InputErrorOf([&] { CopyLargestFeatures(full, folder.path() / "coarse.db", 3); }),
              testing::AllOf(HasSubstr("locked"), HasSubstr("run again"),
                             testing::Not(HasSubstr("remove"))));
}

TEST(ReadMatchedPairs, ReturnsTheNamesOfThePhotographs) {
  const ScratchFolder folder;
  const auto path = folder.path() / "d.db";
  WriteColmapDatabase(path, {{"b.jpg", {}}, {"a.jpg", {}}, {"c.jpg", {}}},
                      {{0, 1, 40}, {1, 2, 0}, {0, 2, 15}});
  const auto pairs = ReadMatchedPairs(path);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].first + " " + pairs[0].second, "a.jpg b.jpg");
  EXPECT_EQ(pairs[0].inliers, 40);
  EXPECT_EQ(pairs[1].first + " " + pairs[1].second, "b.jpg c.jpg");
  EXPECT_THAT(ReadImageNames(path), ElementsAre("a.jpg", "b.jpg", "c.jpg"));
}

TEST(SelectPairs, TakesTheBestOfEachPhotographAndItsNeighboursByName) {
  const std::vector<std::string> names = {"d", "a", "c", "b"};
  const std::vector<MatchedPair> pairs = {
      {"a", "b", 10}, {"a", "c", 50}, {"a", "d", 40}, {"b", "c", 5}, {"b", "d", 30}};
  EXPECT_THAT(SelectPairs(pairs, names, 1, 0),
              ElementsAre(Pair("a", "c"), Pair("a", "d"), Pair("b", "d")));
  EXPECT_THAT(SelectPairs(pairs, names, 0, 1),
              ElementsAre(Pair("a", "b"), Pair("b", "c"), Pair("c", "d")));
  EXPECT_EQ(SelectPairs(pairs, names, 9, 9).size(), 6u);
  EXPECT_TRUE(SelectPairs({}, {}, 3, 3).empty());
}

}  // namespace
}  // namespace nerf::sfm
