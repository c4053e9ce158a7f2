#include "sfm/colmap_program.h"

#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <sys/wait.h>

#include <boost/process.hpp>
#include <boost/process/extend.hpp>
#include <csignal>
#include <fstream>
#include <optional>
#include <regex>

#include "nerf/base/input_error.h"

namespace nerf::sfm {
namespace {

namespace bp = boost::process;

//   temporary  folder for temporary files and the logs that COLMAP writes by itself; empty: as
//   usual
bp::child Start(const std::filesystem::path& executable, std::vector<std::string> arguments,
                bp::ipstream& output, const std::filesystem::path& temporary = {}) {
  bp::environment environment = boost::this_process::environment();
  environment["QT_QPA_PLATFORM"] = "offscreen";
  if (!temporary.empty()) environment["TMPDIR"] = temporary.string();
  environment["TERM"] = "dumb";  // COLMAP 4 colours its messages even in a pipe
  try {
    return bp::child(bp::exe = executable.string(), bp::args = std::move(arguments), environment,
                     (bp::std_out & bp::std_err) > output, bp::std_in < bp::null,
                     bp::extend::on_exec_setup([](auto&) {
#ifdef __linux__
                       prctl(PR_SET_PDEATHSIG, SIGTERM);
#endif
                     }));
  } catch (const bp::process_error& e) {
    throw InputError("{}: cannot be started: {}", executable.string(), e.what());
  }
}

// Keeps the line of the output that explains a failure: the last error message, or else the last
// line that is neither empty nor part of a stack trace.
class FailureLine {
 public:
  void Add(const std::string& line) {
    constexpr std::size_t kLongest = 300;
    const std::size_t begin = line.find_first_not_of(" \t\r=-*");
    if (begin == std::string::npos || line[begin] == '@' || line.find("stack trace") != line.npos) {
      return;
    }
    const std::string text = line.substr(begin, kLongest);
    last_ = text;
    // From 3.9 on, errors are lines of glog: "E20261129 12:00:00.0 123 sfm.cc:288] ...".
    static const std::regex error("^[EF]\\d{4}|error|check failed|what\\(\\):|not enough|no good",
                                  std::regex::icase);
    if (std::regex_search(text, error)) last_error_ = text;
  }
  std::string Get() const { return last_error_.empty() ? last_ : last_error_; }

 private:
  std::string last_;
  std::string last_error_;
};

}  // namespace

bool ColmapProgram::IsInstalled() { return !bp::search_path("colmap").empty(); }

ColmapProgram ColmapProgram::Find() {
  const boost::filesystem::path found = bp::search_path("colmap");
  if (found.empty()) {
    throw InputError(
        "COLMAP is not installed; run apt install colmap (Debian, Ubuntu; for other systems see "
        "colmap.github.io/install.html), or give poses: a transforms.json or a COLMAP project");
  }
  return ColmapProgram(found.string());
}

std::array<int, 3> ColmapProgram::Version() {
  if (version_) return *version_;
  version_.emplace();
  bp::ipstream output;
  bp::child child = Start(executable_, {"help"}, output);
  static const std::regex version(R"(^COLMAP (\d{1,4})\.(\d{1,4})(?:\.(\d{1,4}))?)");
  for (std::string line; std::getline(output, line);) {
    std::smatch match;
    if (!std::regex_search(line, match, version)) continue;
    for (int i = 0; i < 3; ++i) (*version_)[i] = match[i + 1].matched ? std::stoi(match[i + 1]) : 0;
  }
  child.wait();
  return *version_;
}

bool ColmapProgram::ResolvesLinks() {
  const std::array<int, 3> version = Version();
  return version >= std::array{3, 13, 0} && version < std::array{4, 0, 4};
}

std::string ColmapProgram::KnownOption(const std::string& command,
                                       const std::vector<std::string>& names) {
  const auto [known, is_new] = options_.try_emplace(command);
  if (is_new) {
    bp::ipstream output;
    bp::child child = Start(executable_, {command, "-h"}, output);
    static const std::regex option("--([A-Za-z_.0-9]+)");
    for (std::string line; std::getline(output, line);) {
      std::smatch match;
      if (std::regex_search(line, match, option)) known->second.insert(match[1]);
    }
    child.wait();
  }
  for (const std::string& name : names) {
    if (known->second.contains(name)) return name;
  }
  return {};
}

ColmapProgram::Outcome ColmapProgram::Run(
    const std::string& command, const std::vector<std::string>& arguments,
    const std::filesystem::path& log_file,
    const std::function<void(std::string_view)>& on_line) const {
  std::ofstream log(log_file);
  log << executable_.string() << ' ' << command;
  for (const std::string& argument : arguments) log << ' ' << argument;
  log << std::endl;
  const auto check_log = [&] {
    if (!log) throw InputError("{}: cannot be written; is the disk full?", log_file.string());
  };
  check_log();

  std::vector<std::string> all = {command};
  all.insert(all.end(), arguments.begin(), arguments.end());
  bp::ipstream output;
  bp::child child = Start(executable_, std::move(all), output, log_file.parent_path());
  FailureLine failure;
  try {
    for (std::string line; std::getline(output, line);) {
      log << line << std::endl;
      check_log();
      failure.Add(line);
      on_line(line);
    }
  } catch (...) {
    // Not child.terminate(), which leaves a zombie process.
    kill(child.id(), SIGKILL);
    std::error_code ignored;
    child.wait(ignored);
    throw;
  }
  child.wait();
  const int status = child.native_exit_code();
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGINT || WTERMSIG(status) == SIGTERM)) {
    throw InputError("colmap {} was interrupted; run the same command again to continue", command);
  }
  if (WIFSIGNALED(status)) {
    throw InputError(
        "colmap {} was killed by signal {}{}; its last output: {}; log: {}", command,
        WTERMSIG(status),
        WTERMSIG(status) == SIGKILL ? " (out of memory? try --max-image-size 1000)" : "",
        failure.Get(), log_file.string());
  }
  return {child.exit_code(), failure.Get()};
}

void ThrowStepFailed(const std::string& command, const ColmapProgram::Outcome& outcome,
                     const std::filesystem::path& log_file) {
  throw InputError("colmap {} failed (exit status {}): {}; see {}", command, outcome.exit_code,
                   outcome.last_line.empty() ? "no output" : outcome.last_line, log_file.string());
}

StepProgress ParseProgress(std::string_view line) {
  static const std::regex file(
      R"((?:Processed file|Matching image|Processing image) \[(\d{1,9})/(\d{1,9})\])");
  static const std::regex block(
      R"((?:Matching|Processing) block \[(\d{1,4})/(\d{1,4}), (\d{1,4})/(\d{1,4})\])");
  static const std::regex registering(
      R"(Registering image #\d+ \((?:num_reg_frames=)?(\d{1,9})\))");
  std::cmatch match;
  const auto number = [&match](int group) { return std::stoi(match[group].str()); };
  const char* begin = line.data();
  const char* end = begin + line.size();
  if (std::regex_search(begin, end, match, file)) return {number(1), number(2)};
  if (std::regex_search(begin, end, match, block)) {
    return {(number(1) - 1) * number(4) + number(3), number(2) * number(4)};
  }
  if (std::regex_search(begin, end, match, registering)) return {number(1), 0};
  return {};
}

}  // namespace nerf::sfm
