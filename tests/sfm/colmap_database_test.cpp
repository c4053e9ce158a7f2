#include "sfm/colmap_database.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/colmap_database_file.h"
#include "tests/support/feature_scene.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf::sfm {
namespace {

using nerf::test::InputErrorOf;
using nerf::test::ScratchFolder;
using nerf::test::WriteColmapDatabase;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Database : public testing::Test {
 protected:
  Database() {
    WriteColmapDatabase(path_,
                        {{"b.jpg", scene_.features[0]}, {"a.jpg", scene_.features[1]}, {"c.jpg"}});
  }
  std::string ErrorOfReading() {
    return InputErrorOf([&] { ColmapDatabase(path_).ReadFeatures(0); });
  }
  void Execute(const std::string& statement) {
    SQLite::Database(path_.string(), SQLite::OPEN_READWRITE).exec(statement);
  }

  test::FeatureScene scene_ = test::FeatureScene({.images = 2, .points = 20});
  ScratchFolder folder_;
  std::filesystem::path path_ = folder_.path() / "d.db";
};

TEST_F(Database, ReadsFeaturesByName) {
  const ColmapDatabase database(path_);
  EXPECT_THAT(database.Names(), ElementsAre("a.jpg", "b.jpg", "c.jpg"));
  const Features features = database.ReadFeatures(1);
  EXPECT_EQ(features.positions, scene_.features[0].positions);
  EXPECT_EQ(features.descriptors, scene_.features[0].descriptors);
  for (int i = 0; i < features.Count(); ++i) {
    EXPECT_FLOAT_EQ(features.scales[i], scene_.features[0].scales[i]);
  }
  EXPECT_EQ(database.ReadFeatures(2).Count(), 0);
}

// COLMAP's order within a pair is that of its ids, which here is not that of the names.
TEST_F(Database, KeepsMatchesInTheOrderOfColmap) {
  ColmapDatabase database(path_);
  const Eigen::Matrix3d fundamental = (Eigen::Matrix3d() << 0, 1, 2, 3, 4, 5, 6, 7, 8).finished();
  database.Write(std::vector<PairMatches>{{{0, 1}, {{3, 5}, {4, 6}}, {{3, 5}}, fundamental},
                                          {{1, 2}, {}, {}}});
  EXPECT_THAT(database.MatchedPairs(), ElementsAre(ImagePair{0, 1}, ImagePair{1, 2}));
  EXPECT_THAT(database.VerifiedPairs(), ElementsAre(std::pair(ImagePair{0, 1}, 1)));
  EXPECT_THAT(database.ReadVerified({0, 1}), ElementsAre(FeatureMatch{3, 5}));
  EXPECT_TRUE(database.ReadVerified({0, 2}).empty());
  SQLite::Database file(path_.string());
  // a.jpg has the id 2, b.jpg 3.
  SQLite::Statement row(file,
                        "SELECT pair_id, rows, cols, data, config, F FROM "
                        "two_view_geometries WHERE rows > 0");
  ASSERT_TRUE(row.executeStep());
  EXPECT_EQ(row.getColumn(0).getInt64(), 2 * 2147483647LL + 3);
  EXPECT_EQ(row.getColumn(2).getInt(), 2);
  EXPECT_EQ(row.getColumn(4).getInt(), 3);
  const auto* numbers = static_cast<const std::uint32_t*>(row.getColumn(3).getBlob());
  EXPECT_EQ(numbers[0], 3u);
  EXPECT_EQ(numbers[1], 5u);
  const auto* by_rows = static_cast<const double*>(row.getColumn(5).getBlob());
  for (int i = 0; i < 9; ++i) EXPECT_EQ(by_rows[i], i);
}

TEST_F(Database, SwapsPairsWhoseIdsFall) {
  WriteColmapDatabase(path_, {{"a.jpg", scene_.features[0]}, {"b.jpg", scene_.features[1]}});
  ColmapDatabase database(path_);
  const Eigen::Matrix3d fundamental = (Eigen::Matrix3d() << 0, 1, 2, 3, 4, 5, 6, 7, 8).finished();
  database.Write(std::vector<PairMatches>{{{0, 1}, {{3, 5}}, {{3, 5}}, fundamental}});
  EXPECT_THAT(database.ReadVerified({0, 1}), ElementsAre(FeatureMatch{3, 5}));
  SQLite::Database file(path_.string());
  SQLite::Statement row(file, "SELECT pair_id, data, F FROM two_view_geometries");
  ASSERT_TRUE(row.executeStep());
  EXPECT_EQ(row.getColumn(0).getInt64(), 1 * 2147483647LL + 2);
  EXPECT_EQ(static_cast<const std::uint32_t*>(row.getColumn(1).getBlob())[0], 5u);
  EXPECT_EQ(static_cast<const double*>(row.getColumn(2).getBlob())[1], 3);  // transposed
}

TEST_F(Database, ADamagedDatabaseIsNamedWithTheFix) {
  Execute("UPDATE keypoints SET rows = 900");
  EXPECT_THAT(ErrorOfReading(), AllOf(HasSubstr("d.db"), HasSubstr("remove it")));
  WriteColmapDatabase(path_, {{"a.jpg", scene_.features[0]}});
  Execute("UPDATE keypoints SET rows = rows - 1, data = substr(data, 1, length(data) - 24)");
  EXPECT_THAT(ErrorOfReading(), HasSubstr("differ in number"));
  folder_.Write("d.db", "this is no database, but long enough to look at");
  EXPECT_THAT(ErrorOfReading(), AllOf(HasSubstr("d.db"), HasSubstr("remove it")));
}

TEST_F(Database, OtherFeaturesThanSiftAreNamed) {
  Execute("UPDATE descriptors SET rows = rows * 2, cols = 64");
  Execute("UPDATE keypoints SET rows = rows * 2, cols = 3");
  EXPECT_THAT(ErrorOfReading(), HasSubstr("other than SIFT"));
}

// Computing features takes long, so the message must not suggest removing them.
TEST_F(Database, ALockedDatabaseIsNotToBeRemoved) {
  SQLite::Database other(path_.string(), SQLite::OPEN_READWRITE);
  other.exec("BEGIN EXCLUSIVE");
  EXPECT_THAT(ErrorOfReading(),
              AllOf(HasSubstr("locked"), HasSubstr("run again"), Not(HasSubstr("remove"))));
}

}  // namespace
}  // namespace nerf::sfm
