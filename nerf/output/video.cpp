#include "nerf/output/video.h"

#include <algorithm>
#include <boost/process.hpp>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/temporary_file.h"

namespace nerf {
namespace {

namespace bp = boost::process;
namespace fs = std::filesystem;

// The pattern for the image reader of ffmpeg; percent signs in the name of the folder are escaped.
std::string FramePattern(const fs::path& folder) {
  std::string pattern = "file:";
  for (const char c : folder.string()) pattern += c == '%' ? "%%" : std::string(1, c);
  return pattern + "/%05d.png";
}

std::vector<std::string> Arguments(const fs::path& frames_folder, int frames,
                                   double frames_per_second, const fs::path& output) {
  return {"-nostdin",
          "-y",
          "-loglevel",
          "error",
          "-framerate",
          fmt::format("{}", frames_per_second),
          "-start_number",
          "0",
          "-i",
          FramePattern(frames_folder),
          "-frames:v",
          fmt::format("{}", frames),
          "-vf",
          "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
          "-c:v",
          "libx264",
          "-crf",
          "18",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "bt709",
          "-movflags",
          "+faststart",
          "file:" + output.string()};
}

}  // namespace

bool FfmpegIsInstalled() { return !bp::search_path("ffmpeg").empty(); }

std::string FrameName(int index) { return fmt::format("{:05d}.png", index); }

void WriteVideo(const fs::path& frames_folder, int frames, double frames_per_second,
                const fs::path& video) {
  if (video.extension() != ".mp4") {
    throw InputError("{}: films are written as .mp4; choose that extension", video.string());
  }
  if (!(frames_per_second > 0 && frames_per_second <= 1000)) {
    throw InputError("{}: {} frames per second, give more than 0 and at most 1000", video.string(),
                     frames_per_second);
  }
  for (int i = 0; i < std::max(1, frames); ++i) {
    if (fs::exists(frames_folder / FrameName(i))) continue;
    throw InputError("{}: frame of the film not found", (frames_folder / FrameName(i)).string());
  }
  const boost::filesystem::path ffmpeg = bp::search_path("ffmpeg");
  if (ffmpeg.empty()) {
    throw InputError("{}: films need the program ffmpeg; install it (apt install ffmpeg)",
                     video.string());
  }
  TemporaryFile file(video);
  bp::ipstream errors;
  bp::child child(ffmpeg,
                  bp::args = Arguments(frames_folder, frames, frames_per_second, file.path()),
                  bp::std_in<bp::null, bp::std_out> bp::null, bp::std_err > errors);
  std::string last_line;
  for (std::string line; std::getline(errors, line);) {
    if (!line.empty()) last_line = line;
  }
  child.wait();
  if (child.exit_code() != 0) {
    throw InputError("{}: ffmpeg failed: {}", video.string(),
                     last_line.empty() ? "no message" : last_line);
  }
  file.Keep();
}

}  // namespace nerf
