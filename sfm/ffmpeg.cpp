#include "sfm/ffmpeg.h"

#include <algorithm>
#include <boost/process.hpp>
#include <nlohmann/json.hpp>
#include <thread>

#include "nerf/base/input_error.h"

namespace nerf::sfm {
namespace {

namespace bp = boost::process;
namespace fs = std::filesystem;
using nlohmann::json;

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

// ffprobe writes numbers as strings.
double NumberIn(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) return 0;
  if (found->is_number()) return found->get<double>();
  return found->is_string() ? std::strtod(found->get<std::string>().c_str(), nullptr) : 0;
}

// The length of a film whose header does not have it, as where it was recorded as a stream.
double SecondsOfPackets(const fs::path& film) {
  double last = 0;
  RunFilmProgram("ffprobe", film,
                 {"-v", "error", "-select_streams", "v:0", "-show_entries", "packet=pts_time",
                  "-of", "csv=p=0", "file:" + film.string()},
                 [&](std::istream& output) {
                   for (std::string line; std::getline(output, line);) {
                     last = std::max(last, std::strtod(line.c_str(), nullptr));
                   }
                 });
  return last;
}

}  // namespace

void RunFilmProgram(const char* name, const fs::path& film,
                    const std::vector<std::string>& arguments,
                    const std::function<void(std::istream& output)>& read) {
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

FilmFacts ProbeFilm(const fs::path& film) {
  std::string text;
  RunFilmProgram(
      "ffprobe", film,
      {"-v", "error", "-select_streams", "v:0", "-show_entries",
       "stream=avg_frame_rate,duration,width,height:format=duration", "-of", "json",
       "file:" + film.string()},
      [&](std::istream& output) { text.assign(std::istreambuf_iterator<char>(output), {}); });
  const json root = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!root.is_object() || !root.contains("streams") || root["streams"].empty()) {
    ThrowUnreadable(film, "it has no pictures");
  }
  const json& stream = root["streams"][0];
  FilmFacts facts;
  facts.width = static_cast<int>(NumberIn(stream, "width"));
  facts.height = static_cast<int>(NumberIn(stream, "height"));
  facts.seconds = NumberIn(stream, "duration");
  if (facts.seconds == 0 && root.contains("format")) {
    facts.seconds = NumberIn(root["format"], "duration");
  }
  const std::string rate = stream.value("avg_frame_rate", "0/0");
  const std::size_t slash = rate.find('/');
  const double divisor = slash == std::string::npos ? 1 : std::strtod(&rate[slash + 1], nullptr);
  if (divisor > 0) facts.frames_per_second = std::strtod(rate.c_str(), nullptr) / divisor;
  if (!(facts.seconds > 0)) facts.seconds = SecondsOfPackets(film);
  if (!(facts.seconds > 0)) ThrowUnreadable(film, "its length is unknown");
  return facts;
}

}  // namespace nerf::sfm
