#include "nerf/output/video.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <boost/process.hpp>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>

#include "nerf/base/input_error.h"
#include "nerf/image/image_io.h"

namespace nerf {
namespace {

namespace bp = boost::process;
namespace fs = std::filesystem;
using testing::HasSubstr;

// Makes PATH empty during its lifetime.
class WithoutPrograms {
 public:
  WithoutPrograms() { ::setenv("PATH", "/nonexistent", 1); }
  ~WithoutPrograms() { ::setenv("PATH", path_.c_str(), 1); }
  WithoutPrograms(const WithoutPrograms&) = delete;
  WithoutPrograms& operator=(const WithoutPrograms&) = delete;

 private:
  std::string path_ = std::getenv("PATH");
};

class Video : public testing::Test {
 protected:
  Video() { fs::create_directories(frames_); }
  ~Video() override { fs::remove_all(folder_); }

  void WriteFrames(int count, int width, int height) const {
    for (int i = 0; i < count; ++i) {
      Image image(width, height, 3);
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) image.At(x, y)[i % 3] = static_cast<float>(x) / width;
      }
      WriteImage(frames_ / FrameName(i), image);
    }
  }
  std::string ErrorOf(const std::function<void()>& call) const {
    try {
      call();
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  }
  int NumFiles() const {
    return static_cast<int>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_ = fs::temp_directory_path() / ("nerf video 100% " + std::to_string(::getpid()));
  fs::path frames_ = folder_ / "frames %d";
};

std::string Probe(const fs::path& video) {
  bp::ipstream output;
  bp::child child(bp::search_path("ffprobe"),
                  bp::args = {"-v", "error", "-count_frames", "-show_entries",
                              "stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames",
                              "-of", "default=noprint_wrappers=1", video.string()},
                  bp::std_out > output);
  std::string text;
  for (std::string line; std::getline(output, line);) text += line + "\n";
  child.wait();
  return text;
}

TEST_F(Video, EncodesFramesAsPlayableVideo) {
  ASSERT_TRUE(FfmpegIsInstalled()) << "these tests need the program ffmpeg";
  WriteFrames(5, 33, 21);  // odd: padded
  WriteVideo(frames_, 5, 12.5, folder_ / "film.mp4");
  const std::string found = Probe(folder_ / "film.mp4");
  for (const char* line : {"codec_name=h264", "width=34", "height=22", "pix_fmt=yuv420p",
                           "r_frame_rate=25/2", "nb_read_frames=5"}) {
    EXPECT_THAT(found, HasSubstr(line));
  }
  EXPECT_EQ(NumFiles(), 2);  // the folder of the frames, and the film
}

TEST_F(Video, IgnoresFramesOfAnEarlierRendering) {
  WriteFrames(6, 32, 32);
  WriteVideo(frames_, 3, 30, folder_ / "film.mp4");
  EXPECT_THAT(Probe(folder_ / "film.mp4"), HasSubstr("nb_read_frames=3"));
  EXPECT_THAT(ErrorOf([&] { WriteVideo(frames_, 7, 30, folder_ / "film.mp4"); }),
              HasSubstr("00006.png"));
}

TEST_F(Video, ErrorsIncludeTheMessageOfFfmpeg) {
  WriteFrames(1, 32, 32);
  std::ofstream(frames_ / FrameName(0)) << "no picture";
  const std::string error = ErrorOf([&] { WriteVideo(frames_, 1, 30, folder_ / "film.mp4"); });
  EXPECT_THAT(error, testing::AllOf(HasSubstr("film.mp4"), HasSubstr("ffmpeg failed: ")));
  EXPECT_EQ(error.find("no message"), std::string::npos);
  EXPECT_EQ(error.find('\n'), std::string::npos);
  EXPECT_EQ(NumFiles(), 1);
}

TEST_F(Video, ReportsThatFfmpegIsMissing) {
  WriteFrames(1, 32, 32);
  const WithoutPrograms nothing_installed;
  EXPECT_FALSE(FfmpegIsInstalled());
  EXPECT_THAT(ErrorOf([&] { WriteVideo(frames_, 1, 30, folder_ / "film.mp4"); }),
              HasSubstr("install"));
}

TEST_F(Video, ErrorsNameInvalidExtensionsRatesAndFolders) {
  EXPECT_THAT(ErrorOf([&] { WriteVideo(frames_, 1, 30, folder_ / "film.mp4"); }),
              HasSubstr("00000.png"));
  WriteFrames(1, 32, 32);
  EXPECT_THAT(ErrorOf([&] { WriteVideo(frames_, 1, 30, folder_ / "film.avi"); }),
              HasSubstr(".mp4"));
  EXPECT_THAT(ErrorOf([&] { WriteVideo(frames_, 1, 0, folder_ / "film.mp4"); }),
              HasSubstr("frames per second"));
  EXPECT_THAT(ErrorOf([&] { WriteVideo(frames_, 1, 30, folder_ / "no" / "film.mp4"); }),
              HasSubstr("does not exist"));
}

}  // namespace
}  // namespace nerf
