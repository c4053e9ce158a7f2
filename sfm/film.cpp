#include "sfm/film.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <boost/process.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/progress.h"
#include "nerf/base/text.h"
#include "sfm/frame_choice.h"

namespace nerf::sfm {
namespace {

namespace bp = boost::process;
namespace fs = std::filesystem;
using nlohmann::json;

// Frames that are compared in each part of the film, and their size: large enough that motion blur
// of a few pixels shows.
constexpr int kCandidates = 5;
constexpr int kSide = 640;
constexpr double kShortest = 0.95;  // seconds; no camera moves far enough in less
constexpr const char* kRecord = "film.json";

boost::filesystem::path FindProgram(const char* name, const fs::path& film) {
  const boost::filesystem::path program = bp::search_path(name);
  if (!program.empty()) return program;
  throw InputError("{}: films need the program {}; install it (apt install ffmpeg)", film.string(),
                   name);
}

[[noreturn]] void ThrowUnreadable(const fs::path& film, const std::string& message) {
  throw InputError("{}: cannot be read as a film: {}", film.string(),
                   message.empty() ? "no message" : message);
}

// Runs a program and passes its standard output to `read`.
//   returns  the last line of its standard error, if it failed
template <class Read>
void Run(const char* name, const fs::path& film, const std::vector<std::string>& arguments,
         Read&& read) {
  bp::ipstream output, errors;
  bp::child child(FindProgram(name, film), bp::args = arguments,
                  bp::std_in<bp::null, bp::std_out> output, bp::std_err > errors);
  // Read beside the output, so that neither pipe fills up.
  std::string last_line;
  std::thread reader([&] {
    for (std::string line; std::getline(errors, line);) {
      if (!line.empty()) last_line = line;
    }
  });
  read(output);
  child.wait();
  reader.join();
  if (child.exit_code() != 0) ThrowUnreadable(film, last_line);
}

struct Film {
  double seconds = 0, frames_per_second = 0;
};

// The length of a film whose header does not have it, as where it was recorded as a stream.
double SecondsOfPackets(const fs::path& film) {
  double last = 0;
  Run("ffprobe", film,
      {"-v", "error", "-select_streams", "v:0", "-show_entries", "packet=pts_time", "-of",
       "csv=p=0", "file:" + film.string()},
      [&](std::istream& output) {
        for (std::string line; std::getline(output, line);) {
          last = std::max(last, std::strtod(line.c_str(), nullptr));
        }
      });
  return last;
}

Film Probe(const fs::path& film) {
  std::string text;
  Run("ffprobe", film,
      {"-v", "error", "-select_streams", "v:0", "-show_entries",
       "stream=avg_frame_rate,duration:format=duration", "-of", "json", "file:" + film.string()},
      [&](std::istream& output) { text.assign(std::istreambuf_iterator<char>(output), {}); });
  const json root = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!root.is_object() || !root.contains("streams") || root["streams"].empty()) {
    ThrowUnreadable(film, "it has no pictures");
  }
  const json& stream = root["streams"][0];
  const auto number = [](const json& object, const char* key) {
    return object.contains(key) && object[key].is_string()
               ? std::strtod(object[key].get<std::string>().c_str(), nullptr)
               : 0.0;
  };
  Film probed;
  probed.seconds = number(stream, "duration");
  if (probed.seconds == 0 && root.contains("format")) {
    probed.seconds = number(root["format"], "duration");
  }
  const std::string rate = stream.value("avg_frame_rate", "0/0");
  const std::size_t slash = rate.find('/');
  const double divisor = slash == std::string::npos ? 1 : std::strtod(&rate[slash + 1], nullptr);
  if (divisor > 0) probed.frames_per_second = std::strtod(rate.c_str(), nullptr) / divisor;
  if (!(probed.seconds > 0)) probed.seconds = SecondsOfPackets(film);
  if (!(probed.seconds > 0)) ThrowUnreadable(film, "its length is unknown");
  return probed;
}

// The sharpness of frames at this rate.
std::vector<double> MeasureSharpness(const fs::path& film, double rate, double seconds) {
  std::vector<double> sharpness;
  ProgressLine progress("looking for sharp frames", std::llround(seconds * rate));
  std::vector<std::uint8_t> grey(kSide * kSide);
  Run("ffmpeg", film,
      {"-nostdin", "-v", "error", "-i", "file:" + film.string(), "-vf",
       fmt::format("fps={:.6f},scale={}:{}:flags=area,format=gray", rate, kSide, kSide), "-f",
       "rawvideo", "pipe:1"},
      [&](std::istream& output) {
        while (output.read(reinterpret_cast<char*>(grey.data()), std::ssize(grey))) {
          sharpness.push_back(Sharpness(grey, kSide, kSide));
          progress.Update(std::ssize(sharpness));
        }
      });
  return sharpness;
}

// Writes the frames with these indices, at this rate.
void WriteFrames(const fs::path& film, double rate, const std::vector<int>& frames,
                 const fs::path& folder) {
  std::string select;
  for (const int frame : frames) {
    select += fmt::format("{}eq(n\\,{})", select.empty() ? "" : "+", frame);
  }
  std::string pattern = "file:";
  for (const char c : folder.string()) pattern += c == '%' ? "%%" : std::string(1, c);
  Run("ffmpeg", film,
      {"-nostdin", "-v", "error", "-i", "file:" + film.string(), "-vf",
       fmt::format("fps={:.6f},select='{}'", rate, select), "-vsync", "passthrough", "-q:v", "2",
       "-frames:v", std::to_string(frames.size()), pattern + "/frame_%05d.jpg"},
      [](std::istream&) {});
}

// What the frames of a folder were made from.
json RecordOf(const fs::path& film, int count) {
  std::error_code error;
  return {{"film", fs::absolute(film).lexically_normal().string()},
          {"bytes", fs::file_size(film, error)},
          {"changed", fs::last_write_time(film, error).time_since_epoch().count()},
          {"requested", count}};
}

// Whether a folder has nothing but frames: other files, such as masks of them, must not be lost.
bool HasOnlyFrames(const fs::path& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name != kRecord && !(name.starts_with("frame_") && name.ends_with(".jpg"))) return false;
  }
  return true;
}

// The frames of an earlier call. Throws InputError if the folder has something that must not be
// replaced.
std::optional<FilmFrames> EarlierFrames(const fs::path& folder, const json& record) {
  std::error_code error;
  if (!fs::exists(folder, error) || fs::is_empty(folder, error)) return std::nullopt;
  json found;
  if (fs::exists(folder / kRecord)) {
    found = json::parse(ReadWholeFile(folder / kRecord), nullptr, false);
  }
  bool same = found.is_object() && found.contains("frames");
  for (const auto& [key, value] : record.items()) same = same && found.value(key, json()) == value;
  if (same) {
    return FilmFrames{found.value("frames", 0), found.value("blurred", 0),
                      found.value("seconds", 0.0), true};
  }
  if (!fs::exists(folder / kRecord) || !HasOnlyFrames(folder)) {
    throw InputError(
        "{}: contains files that are no frames of this film; remove the folder, or choose another "
        "output folder",
        folder.string());
  }
  return std::nullopt;
}

}  // namespace

bool HasFilmExtension(const fs::path& file) {
  static constexpr std::array<std::string_view, 13> kExtensions = {
      ".mp4",  ".mov", ".m4v",  ".mkv", ".webm", ".avi", ".mpg",
      ".mpeg", ".mts", ".m2ts", ".3gp", ".wmv",  ".insv"};
  return std::ranges::find(kExtensions, Lowercase(file.extension().string())) != kExtensions.end();
}

FilmFrames ExtractFrames(const fs::path& film, const fs::path& folder, int count) {
  const json record = RecordOf(film, count);
  if (const auto earlier = EarlierFrames(folder, record)) return *earlier;
  const Film probed = Probe(film);
  if (probed.seconds < kShortest) {
    throw InputError(
        "{}: lasts only {:.1f} s; give a film in which the camera moves around the scene for some "
        "seconds",
        film.string(), probed.seconds);
  }
  if (count == 0) count = DefaultFrameCount(probed.seconds);
  // No more candidates than the film has frames.
  double rate = kCandidates * count / probed.seconds;
  if (probed.frames_per_second > 0) rate = std::min(rate, probed.frames_per_second);
  const std::vector<double> sharpness = MeasureSharpness(film, rate, probed.seconds);
  const std::vector<int> chosen = ChooseFrames(sharpness, count);
  if (chosen.size() < 2) {
    throw InputError("{}: has only {} frames that can be used; give a longer film", film.string(),
                     chosen.size());
  }
  FilmFrames result;
  result.frames = static_cast<int>(chosen.size());
  result.blurred = std::min(count, static_cast<int>(sharpness.size())) - result.frames;
  result.seconds = probed.seconds;
  fs::path unfinished = folder;
  unfinished += ".unfinished";
  RemoveAll(unfinished);
  MakeOutputFolder(unfinished);
  WriteFrames(film, rate, chosen, unfinished);
  json written = record;
  written.update({{"frames", result.frames},
                  {"blurred", result.blurred},
                  {"seconds", result.seconds},
                  {"rate", rate},
                  {"indices", chosen}});
  WriteFileAtomically(unfinished / kRecord, written.dump(2) + "\n");
  RemoveAll(folder);
  fs::rename(unfinished, folder);
  return result;
}

}  // namespace nerf::sfm
