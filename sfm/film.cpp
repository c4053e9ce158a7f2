#include "sfm/film.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/progress.h"
#include "nerf/base/text.h"
#include "sfm/ffmpeg.h"
#include "sfm/frame_choice.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Frames that are compared in each part of the film, and their size: large enough that motion blur
// of a few pixels shows.
constexpr int kCandidates = 5;
constexpr int kSide = 640;
constexpr double kShortest = 0.95;            // seconds; no camera moves far enough in less
constexpr double kMegapixelsPerSecond = 250;  // decoded by two cores (H.264)
constexpr const char* kRecord = "film.json";

// The sharpness of frames at this rate.
std::vector<double> MeasureSharpness(const fs::path& film, double rate, double seconds) {
  std::vector<double> sharpness;
  ProgressLine progress("looking for sharp frames", std::llround(seconds * rate));
  std::vector<std::uint8_t> grey(kSide * kSide);
  RunFilmProgram("ffmpeg", film,
                 {"-nostdin", "-v", "error", "-i", "file:" + film.string(), "-vf",
                  fmt::format("fps={:.6f},scale={}:{}:flags=area,format=gray", rate, kSide, kSide),
                  "-f", "rawvideo", "pipe:1"},
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
  RunFilmProgram(
      "ffmpeg", film,
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

// Refuses a film that is too short.
FilmFacts Probe(const fs::path& film) {
  const FilmFacts facts = ProbeFilm(film);
  if (facts.seconds >= kShortest) return facts;
  throw InputError(
      "{}: lasts only {:.1f} s; give a film in which the camera moves around the scene for some "
      "seconds",
      film.string(), facts.seconds);
}

int FrameCount(const FilmFacts& film, int requested) {
  return requested > 0 ? requested : DefaultFrameCount(film.seconds);
}

}  // namespace

bool HasFilmExtension(const fs::path& file) {
  static constexpr std::array<std::string_view, 13> kExtensions = {
      ".mp4",  ".mov", ".m4v",  ".mkv", ".webm", ".avi", ".mpg",
      ".mpeg", ".mts", ".m2ts", ".3gp", ".wmv",  ".insv"};
  return std::ranges::find(kExtensions, Lowercase(file.extension().string())) != kExtensions.end();
}

std::optional<FilmFrames> EarlierFrames(const fs::path& film, const fs::path& folder, int count) {
  std::error_code error;
  if (!fs::exists(folder, error) || fs::is_empty(folder, error)) return std::nullopt;
  const bool recorded = fs::is_regular_file(folder / kRecord);
  const json found =
      json::parse(recorded ? ReadWholeFile(folder / kRecord) : "null", nullptr, false);
  const auto number = [&](const char* key) {
    return found.contains(key) && found[key].is_number() ? found[key].get<double>() : -1.0;
  };
  bool same = found.is_object() && number("frames") >= 2 && number("frames") < 1e6;
  const json record = RecordOf(film, count);
  for (const auto& [key, value] : record.items()) {
    same = same && found.value(key, json()) == value;
  }
  if (same) {
    const double blurred = std::clamp(number("blurred"), 0.0, 1e6);
    return FilmFrames{static_cast<int>(number("frames")), static_cast<int>(blurred),
                      std::max(0.0, number("seconds")), true};
  }
  if (!recorded || !HasOnlyFrames(folder)) {
    throw InputError(
        "{}: contains files that are no frames of this film; remove the folder, or choose another "
        "output folder",
        folder.string());
  }
  return std::nullopt;
}

FilmPlan PlanFrames(const fs::path& film, int count) {
  const FilmFacts facts = Probe(film);
  const double decoded =  // twice, for the choice and for the frames
      2e-6 * facts.width * facts.height * facts.seconds * facts.frames_per_second;
  return {FrameCount(facts, count), std::max(facts.width, facts.height),
          decoded / kMegapixelsPerSecond};
}

FilmFrames ExtractFrames(const fs::path& film, const fs::path& folder, int count) {
  if (const auto earlier = EarlierFrames(film, folder, count)) return *earlier;
  const FilmFacts probed = Probe(film);
  const json record = RecordOf(film, count);
  count = FrameCount(probed, count);
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
