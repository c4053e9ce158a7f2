#include "sfm/colmap_runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "tests/support/colmap_database_file.h"
#include "tests/support/fake_colmap.h"
#include "tests/support/input_error_of.h"
#include "tests/support/photo_files.h"

namespace sfm {
namespace {

namespace fs = std::filesystem;
using nerf::test::FakeColmap;
using nerf::test::InputErrorOf;
using nerf::test::ScratchFolder;
using nerf::test::WriteColmapDatabase;
using nerf::test::WritePhoto;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// What the program would have said on the way.
class LogText {
 public:
  LogText() : before_(spdlog::default_logger()) {
    spdlog::set_default_logger(std::make_shared<spdlog::logger>(
        "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text_)));
  }
  ~LogText() { spdlog::set_default_logger(before_); }
  std::string Text() const { return text_.str(); }

 private:
  std::shared_ptr<spdlog::logger> before_;
  std::ostringstream text_;
};

class ColmapRunner : public testing::Test {
 protected:
  void WritePhotos(int count) const {
    for (int i = 0; i < count; ++i) {
      WritePhoto(photos_.path() / fmt::format("p{:03}.png", i), 64, 48);
    }
  }
  PosedImages Run() {
    report_ = {};
    return PosesFromPhotos(photos_.path(), Workspace(), options_, &report_);
  }
  std::string Error() {
    return InputErrorOf([&] { Run(); });
  }
  fs::path Workspace() const { return out_.path() / "colmap"; }

  FakeColmap fake_;
  ScratchFolder photos_;
  ScratchFolder out_;
  LogText log_;
  ColmapOptions options_;
  ColmapReport report_;
};

TEST_F(ColmapRunner, EachStepRunsOnceAndTheImagesAreTheOriginals) {
  WritePhotos(6);
  fake_.Set("models", "0 6\n");
  const PosedImages posed = Run();
  EXPECT_THAT(fake_.Commands(), ElementsAre("feature_extractor", "exhaustive_matcher", "mapper"));
  ASSERT_EQ(posed.images.size(), 6u);
  EXPECT_EQ(posed.images[2].name, "p002.png");
  EXPECT_EQ(posed.images[2].path, photos_.path() / "p002.png");
  EXPECT_FALSE(posed.images[2].upright_by_exif);
  EXPECT_EQ(report_.photos, 6);
  EXPECT_EQ(report_.registered, 6);
  EXPECT_EQ(report_.points, 1);
  EXPECT_DOUBLE_EQ(report_.mean_reprojection_error, 0.5);
  EXPECT_THAT(report_.unregistered, IsEmpty());
  EXPECT_EQ(report_.seconds.size(), 4u);
  EXPECT_THAT(log_.Text(), Not(HasSubstr("warning")));
}

TEST_F(ColmapRunner, OptionsReachThePrograms) {
  WritePhotos(6);
  fake_.Set("models", "0 6\n");
  options_.camera_model = "OPENCV_FISHEYE";
  options_.max_image_size = 700;
  Run();
  EXPECT_THAT(fake_.Calls()[0],
              AllOf(HasSubstr("--ImageReader.camera_model OPENCV_FISHEYE"),
                    HasSubstr("--ImageReader.single_camera_per_folder 1"),
                    HasSubstr("--SiftExtraction.use_gpu 0"),
                    HasSubstr("--SiftExtraction.max_image_size 700"), Not(HasSubstr("threads"))));
  EXPECT_THAT(fake_.Calls()[1], HasSubstr("--SiftMatching.use_gpu 0"));
}

TEST_F(ColmapRunner, SmallPhotosAreEnlargedToFindFeatures) {
  WritePhotos(6);
  WritePhoto(photos_.path() / "large.png", 1300, 10);
  fake_.Set("models", "0 7\n");
  Run();
  EXPECT_THAT(fake_.Calls()[0], HasSubstr("--SiftExtraction.first_octave 0"));
  options_.max_image_size = 1100;
  fake_.ForgetCalls();
  Run();
  EXPECT_THAT(fake_.Calls()[0], HasSubstr("--SiftExtraction.first_octave -1"));
}

TEST_F(ColmapRunner, NewerProgramsGetTheNewNames) {
  WritePhotos(6);
  fake_.Set("models", "0 6\n");
  fake_.Set("help",
            "--FeatureExtraction.use_gpu arg\n--FeatureMatching.use_gpu arg\n"
            "--FeatureExtraction.num_threads arg\n--FeatureMatching.num_threads arg\n");
  options_.threads = 3;
  Run();
  EXPECT_THAT(fake_.Calls()[0], AllOf(HasSubstr("--FeatureExtraction.use_gpu 0"),
                                      HasSubstr("--FeatureExtraction.num_threads 3"),
                                      Not(HasSubstr("SiftExtraction"))));
  EXPECT_THAT(fake_.Calls()[1], AllOf(HasSubstr("--FeatureMatching.use_gpu 0"),
                                      HasSubstr("--FeatureMatching.num_threads 3")));
}

TEST_F(ColmapRunner, FailingStepIsNamedWithReasonAndLogAndRunsAgainNextTime) {
  WritePhotos(6);
  fake_.Set("models", "0 6\n");
  fake_.Set("do_exhaustive_matcher", "echo 'ERROR: disk I/O error'; exit 1");
  EXPECT_THAT(Error(), AllOf(HasSubstr("colmap exhaustive_matcher failed"),
                             HasSubstr("disk I/O error"), HasSubstr("log/matches.log")));
  fake_.Unset("do_exhaustive_matcher");
  fake_.ForgetCalls();
  Run();
  EXPECT_THAT(fake_.Commands(), ElementsAre("exhaustive_matcher", "mapper"));
}

TEST_F(ColmapRunner, FewRegisteredAreTriedAgainThenRefusedWithAdvice) {
  options_.matcher = "exhaustive";
  WritePhotos(50);
  EXPECT_THAT(Error(), AllOf(HasSubstr("0 of 50"), HasSubstr("overlap"), HasSubstr("colmap/log")));
  EXPECT_THAT(fake_.Calls().back(), HasSubstr("--Mapper.init_min_num_inliers 50"));
  fs::remove_all(Workspace());
  fake_.Set("models", "0 3\n");
  EXPECT_THAT(Error(), HasSubstr("registered 3 of 50 photographs, too few"));
  fs::remove_all(Workspace());
  fake_.Set("models", "0 4\n");  // less than one in ten
  EXPECT_THAT(Error(), HasSubstr("registered 4 of 50 photographs, too few"));
}

TEST_F(ColmapRunner, MapperThatFailsForWantOfAModelIsNoOtherFailure) {
  WritePhotos(6);
  fake_.Set("do_mapper", "echo 'ERROR: failed to create sparse model'; exit 1");
  EXPECT_THAT(Error(), HasSubstr("registered 0 of 6"));
  fs::remove_all(Workspace());
  fake_.Set("do_mapper", "echo 'ERROR: database is locked'; exit 1");
  EXPECT_THAT(Error(), AllOf(HasSubstr("mapper failed"), HasSubstr("database is locked")));
}

TEST_F(ColmapRunner, ModelWithMostImagesCounts) {
  WritePhotos(10);
  fake_.Set("models", "0 2\n1 7\n2 3\n");
  EXPECT_EQ(Run().images.size(), 7u);
  EXPECT_EQ(report_.registered, 7);
  EXPECT_THAT(report_.unregistered, ElementsAre("p007.png", "p008.png", "p009.png"));
  EXPECT_THAT(log_.Text(), AllOf(HasSubstr("7 of 10"), HasSubstr("p007.png, p008.png, p009.png"),
                                 HasSubstr("overlap")));
}

TEST_F(ColmapRunner, SecondAttemptCountsOnlyWhereItIsBetter) {
  WritePhotos(10);
  fake_.Set("models", "0 4\n");
  fake_.Set("models_relaxed", "0 1\n1 9\n");
  EXPECT_EQ(Run().images.size(), 9u);
  EXPECT_FALSE(fs::exists(Workspace() / "sparse_again"));
  fs::remove_all(Workspace());
  fake_.Set("models_relaxed", "0 3\n");
  EXPECT_EQ(Run().images.size(), 4u);
  EXPECT_THAT(log_.Text(), HasSubstr("lower thresholds"));
}

TEST_F(ColmapRunner, SecondCallDoesNothingAgainAndSaysSo) {
  WritePhotos(10);
  fake_.Set("models", "0 4\n");
  fake_.Set("models_relaxed", "0 4\n");
  Run();
  const auto seconds = report_.seconds;
  fake_.ForgetCalls();
  EXPECT_EQ(Run().images.size(), 4u);
  EXPECT_THAT(fake_.Calls(), IsEmpty());
  EXPECT_EQ(report_.seconds, seconds);
  EXPECT_THAT(log_.Text(), HasSubstr("features: done before"));
}

TEST_F(ColmapRunner, ChangesRepeatTheStepsThatDependOnThem) {
  WritePhotos(6);
  fake_.Set("models", "0 6\n");
  Run();
  const auto commands_after = [&](const auto& change) {
    fake_.ForgetCalls();
    change();
    Run();
    return fake_.Commands();
  };
  EXPECT_THAT(commands_after([&] { options_.matcher = "sequential"; }),
              ElementsAre("database_cleaner", "sequential_matcher", "mapper"));
  EXPECT_THAT(commands_after([&] { options_.max_num_features = 500; }),
              ElementsAre("feature_extractor", "sequential_matcher", "mapper"));
  EXPECT_THAT(commands_after([&] { WritePhoto(photos_.path() / "q.png", 64, 48); }),
              ElementsAre("feature_extractor", "sequential_matcher", "mapper"));
  EXPECT_TRUE(fs::exists(Workspace() / "images/q.png"));
  EXPECT_THAT(commands_after([&] { fs::remove(photos_.path() / "q.png"); }),
              Contains("feature_extractor"));
  EXPECT_FALSE(fs::is_symlink(Workspace() / "images/q.png"));
  EXPECT_THAT(commands_after([&] { fs::remove_all(Workspace() / "sparse"); }),
              ElementsAre("mapper"));
}

TEST_F(ColmapRunner, MissingProgramLeavesNothingBehind) {
  WritePhotos(6);
  const std::string path = std::getenv("PATH");
  setenv("PATH", photos_.path().c_str(), 1);
  EXPECT_THAT(Error(), HasSubstr("not installed"));
  setenv("PATH", path.c_str(), 1);
  EXPECT_FALSE(fs::exists(Workspace()));
}

TEST_F(ColmapRunner, OtherPeoplesFilesAreNotTouched) {
  WritePhotos(6);
  fs::create_directories(Workspace() / "images");
  std::ofstream(Workspace() / "images/precious.jpg") << "x";
  EXPECT_THAT(Error(), HasSubstr("not of an earlier run"));
  EXPECT_TRUE(fs::exists(Workspace() / "images/precious.jpg"));
  EXPECT_THAT(fake_.Calls(), IsEmpty());
}

TEST_F(ColmapRunner, UnreadablePhotosAreNamedSkippedAndCounted) {
  WritePhotos(6);
  photos_.Write("p003.png", "broken");
  fake_.Set("models", "0 9\n");
  EXPECT_EQ(Run().images.size(), 5u);
  EXPECT_EQ(report_.photos, 5);
  ASSERT_EQ(report_.skipped.size(), 1u);
  EXPECT_EQ(report_.skipped[0].name, "p003.png");
  EXPECT_THAT(log_.Text(), HasSubstr("p003.png: skipped"));
  EXPECT_FALSE(fs::is_symlink(Workspace() / "images/p003.png"));
}

TEST_F(ColmapRunner, TurnedPhotosKeepTheirPathAndGetTheUprightCamera) {
  for (const char* name : {"a.jpg", "b.jpg", "c.jpg", "d.jpg"}) {
    WritePhoto(photos_.path() / name, 64, 48, 6);
  }
  fake_.Set("models", "0 4\n");
  fake_.Set("size", "48 64");
  const PosedImages posed = Run();
  EXPECT_EQ(posed.images[0].path, photos_.path() / "a.jpg");
  EXPECT_TRUE(posed.images[0].upright_by_exif);
  EXPECT_EQ(posed.cameras[posed.images[0].camera].width, 48);
}

TEST_F(ColmapRunner, SeveralSizesAndStandInsComeBackUnderTheirOwnNames) {
  WritePhoto(photos_.path() / "a.jpg", 64, 48);
  WritePhoto(photos_.path() / "b.exr", 64, 48, 1, OIIO::TypeHalf);
  WritePhoto(photos_.path() / "c.png", 80, 48);
  WritePhoto(photos_.path() / "d.png", 64, 48);
  fake_.Set("models", "0 4\n");
  const PosedImages posed = Run();
  std::vector<std::string> names;
  for (const PosedImage& image : posed.images) {
    names.push_back(image.name);
    EXPECT_EQ(image.path, photos_.path() / image.name);
    EXPECT_EQ(posed.cameras[image.camera].width, image.name == "c.png" ? 80 : 64);
  }
  EXPECT_THAT(names, testing::UnorderedElementsAre("a.jpg", "b.exr", "c.png", "d.png"));
}

TEST_F(ColmapRunner, ManyNumberedPhotosAreMatchedInSequence) {
  for (int i = 0; i < 101; ++i) {
    WritePhoto(photos_.path() / fmt::format("p{:03}.png", i), 16, 12);
  }
  fake_.Set("size", "16 12");
  fake_.Set("models", "0 101\n");
  Run();
  EXPECT_THAT(fake_.Calls()[1],
              AllOf(HasSubstr("sequential_matcher"), HasSubstr("--SequentialMatching.overlap 20")));
}

class GuidedMatching : public ColmapRunner {
 protected:
  // What COLMAP would have found: nothing that fits together, but for the first and the last.
  void FindFeatures(int count) {
    std::vector<nerf::test::DatabaseImage> images;
    for (int i = 0; i < count; ++i) images.push_back({fmt::format("p{:03}.png", i), {1, 2, 3}});
    WriteColmapDatabase(out_.path() / "prepared.db", images, {{0, count - 1, 90}});
    const std::string prepared = (out_.path() / "prepared.db").string();
    fake_.Set("do_feature_extractor", "cp '" + prepared + "' \"$database\"\n");
    // Coarse matches come into the copy, which has forgotten those of the original.
    fake_.Set("do_exhaustive_matcher", "cp '" + prepared + "' \"$database\"\n");
    fake_.Set("do_matches_importer",
              "cat \"$(dirname \"$database\")/pairs.txt\" >> \"$here/pairs\"\n");
  }
};

TEST_F(GuidedMatching, ComparesInFullThosePairsThatLookAlikeAndNeighbours) {
  WritePhotos(30);
  fake_.Set("models", "0 30\n");
  FindFeatures(30);
  Run();
  std::vector<std::string> commands = fake_.Commands();
  commands.erase(std::unique(commands.begin(), commands.end()), commands.end());
  EXPECT_THAT(commands,
              ElementsAre("feature_extractor", "exhaustive_matcher", "matches_importer", "mapper"));
  EXPECT_THAT(fake_.Calls()[1], HasSubstr("coarse.db"));
  const std::string pairs = fake_.Get("pairs");
  EXPECT_EQ(std::ranges::count(pairs, '\n'), 29 + 28 + 1);
  EXPECT_THAT(pairs, AllOf(HasSubstr("p000.png p029.png\n"), HasSubstr("p010.png p012.png\n"),
                           Not(HasSubstr("p010.png p013.png\n"))));
  EXPECT_FALSE(fs::exists(Workspace() / "coarse.db"));
  EXPECT_FALSE(fs::exists(Workspace() / "pairs.txt"));
}

TEST_F(GuidedMatching, ComparesAllPairsWhereTooFewPhotosWereRegistered) {
  WritePhotos(30);
  fake_.Set("models", "0 20\n");
  FindFeatures(30);
  Run();
  EXPECT_THAT(log_.Text(), HasSubstr("20 of 30 registered; the pairs that were left out"));
  EXPECT_EQ(fake_.Commands().back(), "mapper");
  EXPECT_THAT(fake_.Calls()[fake_.Calls().size() - 2],
              AllOf(HasSubstr("exhaustive_matcher"), HasSubstr("database.db")));
  fake_.ForgetCalls();
  Run();
  EXPECT_THAT(fake_.Commands(), IsEmpty());
}

TEST_F(GuidedMatching, ListsHaveNoRoomForNamesWithSpaces) {
  WritePhotos(30);
  fs::rename(photos_.path() / "p007.png", photos_.path() / "p 007.png");
  fake_.Set("models", "0 30\n");
  Run();
  EXPECT_THAT(fake_.Commands(), ElementsAre("feature_extractor", "exhaustive_matcher", "mapper"));
  EXPECT_THAT(log_.Text(), HasSubstr("p 007.png: guided matching"));
}

TEST(NumberedSequence, IsOneTextAroundNumbersOfOneWidth) {
  EXPECT_TRUE(IsNumberedSequence({"0001.jpg", "0002.jpg", "0004.jpg"}));
  EXPECT_TRUE(IsNumberedSequence({"v2_frame_08.png", "v2_frame_09.png", "v2_frame_10.png"}));
  EXPECT_FALSE(IsNumberedSequence({"frame_10.png", "frame_8.png", "frame_9.png"}));
  EXPECT_FALSE(IsNumberedSequence({"a1.jpg", "b2.jpg"}));
  EXPECT_FALSE(IsNumberedSequence({"01.jpg", "02.png"}));
  EXPECT_FALSE(IsNumberedSequence({"front.jpg", "left.jpg"}));
  EXPECT_FALSE(IsNumberedSequence({"0001.jpg", "0002.jpg", "0900.jpg"}));
  EXPECT_FALSE(IsNumberedSequence({"1234567890123456789012345.jpg", "2.jpg"}));
  EXPECT_FALSE(IsNumberedSequence({}));
}

TEST(ColmapOptions, UnknownValuesAreNamedWithTheMend) {
  const auto error = [](auto change) {
    ColmapOptions options;
    change(options);
    return InputErrorOf([&] { options.Check(); });
  };
  EXPECT_EQ(error([](ColmapOptions&) {}), "no error");
  EXPECT_THAT(error([](ColmapOptions& o) { o.matcher = "vocab"; }),
              AllOf(HasSubstr("vocab"), HasSubstr("exhaustive")));
  EXPECT_THAT(error([](ColmapOptions& o) { o.camera_model = "opencv"; }), HasSubstr("OPENCV"));
  EXPECT_THAT(error([](ColmapOptions& o) { o.max_image_size = 0; }), HasSubstr("200"));
  EXPECT_THAT(error([](ColmapOptions& o) { o.max_num_features = 0; }), HasSubstr("200"));
  EXPECT_THAT(error([](ColmapOptions& o) { o.threads = -1; }), HasSubstr("-1"));
}

// The installed COLMAP on a few real photographs, small.
TEST(ColmapRunnerForReal, NeighbouringPhotosOfTheFoxAreRegistered) {
  const ScratchFolder photos;
  const ScratchFolder out;
  for (const char* name : {"0001.jpg", "0002.jpg", "0003.jpg", "0004.jpg", "0006.jpg"}) {
    fs::create_symlink(fs::absolute(fs::path(NERF_TEST_DATA) / "fox/images" / name),
                       photos.path() / name);
  }
  ColmapOptions options;
  options.max_image_size = 640;
  options.max_num_features = 1500;
  options.matcher = "guided";
  ColmapReport report;
  const PosedImages posed = PosesFromPhotos(photos.path(), out.path(), options, &report);
  EXPECT_EQ(report.registered, 5);
  EXPECT_EQ(posed.cameras.size(), 1u);
  EXPECT_EQ(posed.cameras[0].width, 1080);
  EXPECT_GT(report.points, 100);
  EXPECT_LT(report.mean_reprojection_error, 2);
}

}  // namespace
}  // namespace sfm
