#include "nerf/synthetic/sample_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "nerf/image/image_io.h"
#include "nerf/synthetic/capture.h"
#include "sfm/transforms_json.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf::synthetic {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

SampleOptions Tiny(int views = 2) {
  SampleOptions options;
  options.views = views;
  options.width = 24;
  options.height = 18;
  options.samples_per_pixel = 2;
  return options;
}

std::vector<std::string> NamesIn(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), folder).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string Bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(SampleFolder, SeparatesPhotographsAndGroundTruth) {
  const test::ScratchFolder scratch;
  WriteSample(scratch.path() / "new" / "demo", Tiny());
  EXPECT_THAT(
      NamesIn(scratch.path() / "new" / "demo"),
      ElementsAre("images/view_000.png", "images/view_001.png", "truth/sparse/cameras.txt",
                  "truth/sparse/images.txt", "truth/sparse/points3D.txt", "truth/transforms.json",
                  "truth/view_000.albedo.exr", "truth/view_000.depth.exr",
                  "truth/view_000.normal.exr", "truth/view_001.albedo.exr",
                  "truth/view_001.depth.exr", "truth/view_001.normal.exr"));
}

TEST(SampleFolder, MatchesACaptureInMemory) {
  const test::ScratchFolder scratch;
  WriteSample(scratch.path(), Tiny());
  const Capture capture = MakeCapture(Tiny());

  const PosedImages posed = sfm::ReadTransformsJson(scratch.path() / "truth/transforms.json");
  ASSERT_EQ(posed.images.size(), 2u);
  EXPECT_TRUE(fs::equivalent(posed.images[1].path, scratch.path() / "images/view_001.png"));
  EXPECT_TRUE(
      posed.images[1].world_from_camera.isApprox(capture.posed.images[1].world_from_camera, 1e-12));

  const Image photo = ReadImage(scratch.path() / "images/view_001.png", true);
  ASSERT_EQ(photo.pixels.size(), capture.views[1].photo.pixels.size());
  for (std::size_t i = 0; i < photo.pixels.size(); ++i) {
    ASSERT_NEAR(photo.pixels[i], capture.views[1].photo.pixels[i], 0.5 / 255 + 1e-5);
  }
  const Image normal = ReadImage(scratch.path() / "truth/view_001.normal.exr", true);
  EXPECT_EQ(normal.pixels, capture.views[1].normal.pixels);
  // A grey image is read as RGB.
  const Image depth = ReadImage(scratch.path() / "truth/view_001.depth.exr", true);
  EXPECT_EQ(*depth.At(7, 5), *capture.views[1].depth.At(7, 5));
}

TEST(SampleFolder, IsReproducible) {
  const test::ScratchFolder scratch;
  WriteSample(scratch.path(), Tiny());
  const std::string photo = Bytes(scratch.path() / "images/view_000.png");
  EXPECT_FALSE(photo.empty());
  WriteSample(scratch.path(), Tiny());
  EXPECT_EQ(Bytes(scratch.path() / "images/view_000.png"), photo);
}

TEST(SampleFolder, RemovesTheRemainingViewsOfAnEarlierSample) {
  const test::ScratchFolder scratch;
  WriteSample(scratch.path(), Tiny(2));
  const auto two = NamesIn(scratch.path());
  WriteSample(scratch.path(), Tiny(4));
  WriteSample(scratch.path(), Tiny(2));
  EXPECT_EQ(NamesIn(scratch.path()), two);
}

TEST(SampleFolder, ReplacesAnInterruptedSample) {
  const test::ScratchFolder scratch;
  WriteSample(scratch.path(), Tiny());
  const auto whole = NamesIn(scratch.path());
  fs::remove(scratch.path() / "truth/transforms.json");
  scratch.Write("images/.view_001.4242-7.png", "half");
  scratch.Write("truth/transforms.json.tmp4242", "half");
  WriteSample(scratch.path(), Tiny());
  EXPECT_EQ(NamesIn(scratch.path()), whole);
}

TEST(SampleFolder, KeepsOtherSubFolders) {
  const test::ScratchFolder scratch;
  WriteSample(scratch.path(), Tiny());
  scratch.Write("run/checkpoint", "x");
  WriteSample(scratch.path(), Tiny());
  EXPECT_TRUE(fs::exists(scratch.path() / "run/checkpoint"));
}

TEST(SampleFolder, RejectsAForeignFolderAndDoesNotChangeIt) {
  const test::ScratchFolder scratch;
  scratch.Write("images/holiday.jpg", "x");
  EXPECT_THAT(test::InputErrorOf([&] { WriteSample(scratch.path(), Tiny()); }),
              AllOf(HasSubstr(scratch.path().string()), HasSubstr("choose an empty")));
  EXPECT_THAT(NamesIn(scratch.path()), ElementsAre("images/holiday.jpg"));
}

TEST(SampleFolder, RejectsForeignFilesAmongItsPhotographs) {
  const test::ScratchFolder scratch;
  WriteSample(scratch.path(), Tiny());
  for (const char* name : {"images/view_abc.png", "images/view_000.jpg", "truth/notes.txt"}) {
    const fs::path foreign = scratch.Write(name, "x");
    EXPECT_THAT(test::InputErrorOf([&] { WriteSample(scratch.path(), Tiny()); }),
                AllOf(HasSubstr(foreign.string()), HasSubstr("choose an empty")));
    EXPECT_EQ(Bytes(foreign), "x");
    fs::remove(foreign);
  }
}

TEST(SampleFolder, RejectsAFile) {
  const test::ScratchFolder scratch;
  const fs::path file = scratch.Write("demo", "x");
  EXPECT_THAT(test::InputErrorOf([&] { WriteSample(file, Tiny()); }),
              AllOf(HasSubstr(file.string()), HasSubstr("is a file")));
  EXPECT_THAT(test::InputErrorOf([&] { WriteSample(file / "below", Tiny()); }),
              HasSubstr((file / "below").string()));
}

// Root ignores permissions, so this uses a file system in which no folder can be created.
TEST(SampleFolder, ErrorsNameAFolderThatCannotBeCreated) {
  EXPECT_THAT(test::InputErrorOf([] { WriteSample("/proc/no-such-place/demo", Tiny()); }),
              AllOf(HasSubstr("/proc/no-such-place/demo"), HasSubstr("cannot be written")));
}

TEST(SampleFolder, IsNotCreatedForOptionsOutOfRange) {
  const test::ScratchFolder scratch;
  EXPECT_THAT(test::InputErrorOf([&] { WriteSample(scratch.path() / "demo", Tiny(1)); }),
              HasSubstr("--views"));
  EXPECT_FALSE(fs::exists(scratch.path() / "demo"));
}

}  // namespace
}  // namespace nerf::synthetic
