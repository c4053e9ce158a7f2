#include "sfm/colmap_runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/colmap_run.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;
using nerf::test::InputErrorOf;
using nerf::test::ScratchFolder;
using nerf::test::WritePhoto;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class ColmapRunner : public nerf::test::ColmapRun {};

TEST_F(ColmapRunner, EachStepRunsOnceAndTheImagesAreTheOriginals) {
  WritePhotos(6);
  fake_.Set("models", "0 6\n");
  const PosedImages posed = Run();
  EXPECT_THAT(fake_.Commands(), ElementsAre("feature_extractor", "mapper"));
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
  // What this version knows, and nothing else.
  EXPECT_THAT(fake_.Calls()[1], AllOf(HasSubstr("--Mapper.ba_global_images_ratio 1.4"),
                                      Not(HasSubstr("points_ratio"))));
}

TEST_F(ColmapRunner, SmallPhotosAreEnlargedForFeatures) {
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

TEST_F(ColmapRunner, NewerProgramsGetTheNewOptionNames) {
  WritePhotos(6);
  fake_.Set("models", "0 6\n");
  fake_.Set("help",
            "--FeatureExtraction.use_gpu arg\n--FeatureExtraction.num_threads arg\n"
            "--Mapper.ba_global_frames_ratio arg\n--Mapper.num_threads arg\n");
  fake_.Set("version", "COLMAP 4.0.1 (Commit)\n");
  options_.threads = 3;
  EXPECT_EQ(Run().images.size(), 6u);
  // This version would name photographs by what symbolic links point to.
  EXPECT_FALSE(fs::is_symlink(Workspace() / "images/p000.png"));
  EXPECT_THAT(fake_.Calls()[0], AllOf(HasSubstr("--FeatureExtraction.use_gpu 0"),
                                      HasSubstr("--FeatureExtraction.num_threads 3"),
                                      Not(HasSubstr("SiftExtraction"))));
  EXPECT_THAT(fake_.Calls()[1], AllOf(HasSubstr("--Mapper.ba_global_frames_ratio 1.4"),
                                      HasSubstr("--Mapper.num_threads 3")));
}

TEST_F(ColmapRunner, FailingStepIsNamedWithReasonAndLogAndRunsAgainNextTime) {
  WritePhotos(6);
  fake_.Set("models", "0 6\n");
  fake_.Set("do_feature_extractor", "echo 'ERROR: disk I/O error'; exit 1");
  EXPECT_THAT(Error(), AllOf(HasSubstr("colmap feature_extractor failed"),
                             HasSubstr("disk I/O error"), HasSubstr("log/features.log")));
  fake_.Unset("do_feature_extractor");
  fake_.ForgetCalls();
  Run();
  EXPECT_THAT(fake_.Commands(), ElementsAre("feature_extractor", "mapper"));
}

TEST_F(ColmapRunner, FewRegisteredAreMappedAgainThenRefusedWithAdvice) {
  options_.matcher = "exhaustive";
  WritePhotos(50);
  EXPECT_THAT(Error(), AllOf(HasSubstr("0 of 50"), HasSubstr("overlap"), HasSubstr("colmap/log")));
  EXPECT_THAT(fake_.Calls().back(), HasSubstr("--Mapper.init_min_num_inliers 50"));
  fs::remove_all(Workspace());
  fake_.Set("models", "0 3\n");
  EXPECT_THAT(Error(), HasSubstr("registered only 3 of 50 photographs"));
  fs::remove_all(Workspace());
  fake_.Set("models", "0 4\n");  // less than one in ten
  EXPECT_THAT(Error(), HasSubstr("registered only 4 of 50 photographs"));
}

TEST_F(ColmapRunner, MapperThatFindsNoModelIsNotAnotherFailure) {
  WritePhotos(6);
  fake_.Set("do_mapper", "echo 'ERROR: failed to create sparse model'; exit 1");
  EXPECT_THAT(Error(), HasSubstr("registered only 0 of 6"));
  fs::remove_all(Workspace());
  fake_.Set("do_mapper", "echo 'ERROR: database is locked'; exit 1");
  EXPECT_THAT(Error(), AllOf(HasSubstr("mapper failed"), HasSubstr("database is locked")));
}

TEST_F(ColmapRunner, ModelWithMostImagesIsTaken) {
  WritePhotos(10);
  fake_.Set("models", "0 2\n1 7\n2 3\n");
  EXPECT_EQ(Run().images.size(), 7u);
  EXPECT_EQ(report_.registered, 7);
  EXPECT_THAT(report_.unregistered, ElementsAre("p007.png", "p008.png", "p009.png"));
  EXPECT_THAT(log_.Text(), AllOf(HasSubstr("7 of 10"), HasSubstr("p007.png, p008.png, p009.png"),
                                 HasSubstr("overlap")));
}

TEST_F(ColmapRunner, SecondAttemptIsTakenOnlyWhereItIsBetter) {
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

TEST_F(ColmapRunner, SecondCallSkipsFinishedStepsWithAMessage) {
  WritePhotos(10);
  fake_.Set("models", "0 4\n");
  fake_.Set("models_relaxed", "0 4\n");
  Run();
  const auto seconds = report_.seconds;
  fake_.ForgetCalls();
  EXPECT_EQ(Run().images.size(), 4u);
  EXPECT_THAT(fake_.Calls(), IsEmpty());
  EXPECT_EQ(report_.seconds, seconds);
  EXPECT_THAT(log_.Text(), HasSubstr("features: done already"));
}

TEST_F(ColmapRunner, ChangesRepeatTheStepsThatDependOnThem) {
  WritePhotos(6);
  fake_.Set("models", "0 9\n");
  Run();
  const auto commands_after = [&](const auto& change) {
    fake_.ForgetCalls();
    change();
    Run();
    return fake_.Commands();
  };
  EXPECT_THAT(commands_after([&] { options_.matcher = "sequential"; }), ElementsAre("mapper"));
  EXPECT_THAT(commands_after([&] { options_.max_num_features = 500; }),
              ElementsAre("feature_extractor", "mapper"));
  EXPECT_THAT(commands_after([&] { WritePhoto(photos_.path() / "q.png", 64, 48); }),
              ElementsAre("feature_extractor", "mapper"));
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

TEST_F(ColmapRunner, OtherFilesAreNotTouched) {
  WritePhotos(6);
  fs::create_directories(Workspace() / "images");
  std::ofstream(Workspace() / "images/precious.jpg") << "x";
  EXPECT_THAT(Error(), HasSubstr("not from an earlier run"));
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

TEST_F(ColmapRunner, RotatedPhotosKeepTheirPathAndGetTheUprightCamera) {
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

TEST_F(ColmapRunner, SeveralSizesAndConvertedCopiesKeepTheirOriginalNames) {
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

TEST(ColmapOptions, UnknownValuesAreNamedWithTheFix) {
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
}  // namespace nerf::sfm
