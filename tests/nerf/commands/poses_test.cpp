#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>

#include "sfm/pose_input.h"
#include "sfm/transforms_json.h"
#include "tests/support/fake_colmap.h"
#include "tests/support/photo_files.h"
#include "tests/support/scene_folder.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;
using test::FakeColmap;
using test::ScratchFolder;
using test::WritePhoto;
using testing::AllOf;
using testing::HasSubstr;

struct Result {
  int status = -1;
  std::string text;  // standard output and standard error
};

Result RunPoses(const std::string& arguments) {
  Result result;
  FILE* pipe = popen((std::string(NERF_PROGRAM) + " poses " + arguments + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer{};
  while (const std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe)) {
    result.text.append(buffer.data(), count);
  }
  result.status = WEXITSTATUS(pclose(pipe));
  return result;
}

class PosesCommand : public testing::Test {
 protected:
  PosesCommand() {
    for (const char* name : {"a.png", "b.png", "c.png", "d.png", "e.png"}) {
      WritePhoto(photos_.path() / name, 64, 48);
    }
  }
  std::string Arguments() const { return photos_.path().string() + "/ -o " + out_.path().string(); }

  FakeColmap fake_;
  ScratchFolder photos_;
  ScratchFolder out_;
};

TEST_F(PosesCommand, WritesPosesThatCanBeReadBackAndPrintsATable) {
  photos_.Write("broken.png", "x");
  fake_.Set("models", "0 4\n");
  const Result result = RunPoses(Arguments());
  EXPECT_EQ(result.status, 0) << result.text;
  EXPECT_THAT(result.text, AllOf(HasSubstr("registered                4"), HasSubstr("e.png"),
                                 HasSubstr("broken.png"), HasSubstr("0.50 pixels"),
                                 HasSubstr("seconds, matches")));
  const PosedImages posed = sfm::ReadTransformsJson(out_.path() / "transforms.json");
  ASSERT_EQ(posed.images.size(), 4u);
  EXPECT_TRUE(fs::equivalent(posed.images[0].path, photos_.path() / "a.png"));
  EXPECT_NEAR((posed.images[1].world_from_camera.translation() + Eigen::Vector3d(2, 0, 0)).norm(),
              0, 1e-12);
  EXPECT_TRUE(fs::exists(out_.path() / "colmap/sparse/0/images.txt"));
}

TEST_F(PosesCommand, DoesNotOverwriteForeignPoses) {
  fake_.Set("models", "0 5\n");
  out_.Write("transforms.json", "precious");
  const Result result = RunPoses(Arguments());
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.text, HasSubstr("transforms.json: already exists"));
  EXPECT_EQ(test::FileBytes(out_.path() / "transforms.json"), "precious");
}

TEST_F(PosesCommand, BadInputEndsWithStatus2AndOneLine) {
  for (const std::string& arguments :
       {std::string("/absent/folder"),
        photos_.path().string() + " --matcher all -o " + out_.path().string()}) {
    const Result result = RunPoses(arguments);
    EXPECT_EQ(result.status, 2) << result.text;
    EXPECT_EQ(std::count(result.text.begin(), result.text.end(), '\n'), 1) << result.text;
  }
}

TEST_F(PosesCommand, WritesNoTransformsIfTooFewImagesAreRegistered) {
  EXPECT_EQ(RunPoses(Arguments()).status, 2);
  EXPECT_FALSE(fs::exists(out_.path() / "transforms.json"));
}

// Points for poses that are given, and what cannot be done.
class KeepPoses : public testing::Test {
 protected:
  KeepPoses() {
    fake_.SetFeatures(test::WritePhotographsOf(scene_, scene_folder_.path() / "images"));
    sfm::WriteTransformsJson(scene_.posed, scene_folder_.path() / "transforms.json");
  }
  Result Run(const std::string& more = "") {
    return RunPoses(scene_folder_.path().string() + " --keep-poses -o " + out_.path().string() +
                    more);
  }

  FakeColmap fake_;
  test::FeatureScene scene_ = test::FeatureScene({.images = 8, .points = 200});
  ScratchFolder scene_folder_, out_;
};

TEST_F(KeepPoses, WritesAModelThatCanBeTrainedOn) {
  const Result result = Run();
  ASSERT_EQ(result.status, 0) << result.text;
  EXPECT_THAT(result.text, AllOf(HasSubstr("of the matches between photographs fit the poses"),
                                 HasSubstr("sparse points, each in")));
  const PosedImages posed = sfm::ReadPosedInput(sfm::FindInput(out_.path()));
  EXPECT_EQ(posed.images.size(), 8u);
  EXPECT_GT(posed.points.size(), 150u);
  EXPECT_TRUE(
      posed.images[3].world_from_camera.isApprox(scene_.posed.images[3].world_from_camera, 1e-6));
  EXPECT_EQ(Run().status, 0);  // again, into the same folder
}

TEST_F(KeepPoses, ThatContradictThePhotographsAreRefused) {
  for (PosedImage& image : scene_.posed.images) {
    image.world_from_camera = image.world_from_camera.inverse();
  }
  sfm::WriteTransformsJson(scene_.posed, scene_folder_.path() / "transforms.json");
  const Result result = Run();
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.text, HasSubstr("fit the poses; "));
  EXPECT_FALSE(fs::exists(out_.path() / "sparse"));
}

TEST_F(KeepPoses, PhotographsInTheOutputAreNotReplaced) {
  fs::create_directories(out_.path() / "images");
  const Result result = Run();
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.text, HasSubstr("holds photographs; choose another folder"));
  EXPECT_TRUE(fake_.Calls().empty());
  const Result invalid = Run(" --max-image-size 50");
  EXPECT_THAT(invalid.text, HasSubstr("max image size: 50"));
  EXPECT_EQ(Run(" --matcher guided").status, 2);  // has no effect on given poses
}

}  // namespace
}  // namespace nerf
