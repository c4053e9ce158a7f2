#include "sfm/film.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "nerf/base/atomic_file.h"
#include "nerf/image/image_files.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Film : public testing::Test {
 protected:
  // A film of a moving test picture, 96x64 pixels, 25 frames a second.
  fs::path Make(const std::string& name, const std::string& seconds,
                const std::string& filter = "null", const std::string& more = "") {
    const fs::path film = folder_.path() / name;
    const std::string command =
        "ffmpeg -nostdin -v error -y -f lavfi -i testsrc2=size=96x64:rate=25:duration=" + seconds +
        " -vf \"" + filter + "\" -c:v mpeg4 -q:v 2 " + more + " '" + film.string() + "'";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    return film;
  }
  FilmFrames Extract(const fs::path& film, int count) {
    return ExtractFrames(film, Frames(), count);
  }
  fs::path Frames() const { return folder_.path() / "frames %d"; }

  test::ScratchFolder folder_;
};

TEST_F(Film, GivesNumberedFramesAtEvenDistances) {
  const FilmFrames frames = Extract(Make("clip one.mp4", "4"), 10);
  EXPECT_EQ(frames.frames, 10);
  EXPECT_EQ(frames.blurred, 0);
  EXPECT_NEAR(frames.seconds, 4, 0.1);
  EXPECT_FALSE(frames.existed);
  const auto files = ImageFilesIn(Frames());
  ASSERT_EQ(files.size(), 10u);
  EXPECT_EQ(files.front().filename(), "frame_00001.jpg");
  EXPECT_EQ(files.back().filename(), "frame_00010.jpg");
  EXPECT_EQ(ReadImageSize(files[0])->width, 96);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 2);
}

TEST_F(Film, IsReadOnceForTheSameNumber) {
  const fs::path film = Make("clip.mp4", "2");
  Extract(film, 6);
  const auto written = fs::last_write_time(Frames() / "frame_00001.jpg");
  EXPECT_TRUE(Extract(film, 6).existed);
  EXPECT_EQ(fs::last_write_time(Frames() / "frame_00001.jpg"), written);
  EXPECT_EQ(Extract(film, 4).frames, 4);
  EXPECT_EQ(ImageFilesIn(Frames()).size(), 4u);
}

TEST_F(Film, BlurredPartsArePassedOver) {
  const FilmFrames frames =
      Extract(Make("clip.mkv", "4", "boxblur=12:enable='between(t,1.5,2.6)'"), 20);
  EXPECT_GE(frames.blurred, 3);
  EXPECT_EQ(frames.frames + frames.blurred, 20);
}

TEST_F(Film, IsTurnedAsItsFlagSays) {
  const fs::path lying = Make("lying.mov", "1"), film = folder_.path() / "upright.mov";
  const std::string command = "ffmpeg -nostdin -v error -i '" + lying.string() +
                              "' -c copy -metadata:s:v rotate=90 '" + film.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(Extract(film, 4).frames, 4);
  const auto size = ReadImageSize(Frames() / "frame_00001.jpg");
  EXPECT_EQ(size->width, 64);
  EXPECT_EQ(size->height, 96);
}

// Whatever goes wrong, frames that were there stay, and so do files beside them.
TEST_F(Film, FramesAreReplacedOnlyByOthers) {
  Extract(Make("clip.mp4", "1"), 4);
  EXPECT_THAT(test::InputErrorOf([&] { Extract(folder_.Write("broken.mp4", "no film"), 4); }),
              HasSubstr("cannot be read as a film"));
  EXPECT_EQ(ImageFilesIn(Frames()).size(), 4u);
  fs::create_directory(Frames() / "masks");
  EXPECT_THAT(test::InputErrorOf([&] { Extract(folder_.path() / "clip.mp4", 5); }),
              HasSubstr("contains files that are no frames"));
  EXPECT_TRUE(fs::exists(Frames() / "masks"));
  EXPECT_TRUE(Extract(folder_.path() / "clip.mp4", 4).existed);
}

TEST_F(Film, OfUnknownLengthIsMeasured) {
  const fs::path whole = Make("whole.mkv", "2"), stream = folder_.path() / "stream.mkv";
  const std::string command = "ffmpeg -nostdin -v error -i '" + whole.string() +
                              "' -c copy -f matroska - | cat > '" + stream.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const FilmFrames frames = Extract(stream, 8);
  EXPECT_EQ(frames.frames, 8);
  EXPECT_NEAR(frames.seconds, 2, 0.2);
}

TEST_F(Film, PlanIsThatOfTheExtraction) {
  const fs::path film = Make("clip.mp4", "4");
  const FilmPlan plan = PlanFrames(film, 0);
  EXPECT_EQ(plan.frames, Extract(film, 0).frames);
  EXPECT_EQ(plan.longest_side, 96);
  EXPECT_GT(plan.seconds, 0);
  EXPECT_EQ(PlanFrames(film, 7).frames, 7);
}

// A record that somebody edited, or whose types are wrong, is not believed, and no exception but
// InputError leaves the reader.
TEST_F(Film, RecordsOfWrongTypesAreNotBelieved) {
  const fs::path film = Make("clip.mp4", "2");
  Extract(film, 6);
  const fs::path record = Frames() / "film.json";
  ASSERT_TRUE(EarlierFrames(film, Frames(), 6));
  const std::string text = ReadWholeFile(record);
  const std::size_t at = text.find("\"frames\": 6");
  ASSERT_NE(at, std::string::npos);
  WriteFileAtomically(record, text.substr(0, at) + "\"frames\": \"6\"" + text.substr(at + 11));
  EXPECT_FALSE(EarlierFrames(film, Frames(), 6));
  WriteFileAtomically(record, "{");
  EXPECT_FALSE(EarlierFrames(film, Frames(), 6));
}

TEST_F(Film, ThatCannotBeReadIsNamed) {
  const fs::path broken = folder_.Write("broken.mp4", "no film");
  EXPECT_THAT(test::InputErrorOf([&] { Extract(broken, 4); }),
              testing::AllOf(HasSubstr("broken.mp4"), HasSubstr("cannot be read as a film")));
  EXPECT_THAT(test::InputErrorOf([&] { Extract(Make("short.mp4", "0.4"), 4); }),
              testing::AllOf(HasSubstr("short.mp4"), HasSubstr("lasts only 0.4 s")));
  const fs::path film = Make("clip.mp4", "1");
  folder_.Write("mine/notes.txt", "x");
  EXPECT_THAT(test::InputErrorOf([&] { ExtractFrames(film, folder_.path() / "mine", 4); }),
              HasSubstr("no frames of this film"));
  EXPECT_TRUE(fs::exists(folder_.path() / "mine/notes.txt"));
}

}  // namespace
}  // namespace nerf::sfm
