#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace nerf::sfm {

// The installed COLMAP program, version 3.8 or later, run without a display. Since COLMAP 3.13
// renamed options without keeping the old names, the program itself is asked which ones it has.
class ColmapProgram {
 public:
  // Looks up `colmap` in PATH. Throws InputError with instructions to install it.
  static ColmapProgram Find();
  static bool IsInstalled();

  explicit ColmapProgram(std::filesystem::path executable) : executable_(std::move(executable)) {}

  // Major, minor, patch; zeros where the program does not print them.
  std::array<int, 3> Version();
  // Whether this version names a photograph by what a symbolic link in the folder of photographs
  // points to, instead of by the link: 3.13.0 to 4.0.3.
  bool ResolvesLinks();

  // The first of the names that `colmap COMMAND -h` lists; an empty string where it lists none.
  // Runs the program once per command.
  std::string KnownOption(const std::string& command, const std::vector<std::string>& names);

  struct Outcome {
    int exit_code = 0;
    std::string last_line;  // of the output: the last error message, or else the last line
  };

  // Runs `colmap COMMAND ARGUMENTS...`, writes its output to `log_file` and passes it to `on_line`
  // line by line. The child process is killed with this process, and on an exception from
  // `on_line`. Throws InputError when it cannot be started, when the log cannot be written, or when
  // a signal killed it (Ctrl-C, or the system when out of memory).
  Outcome Run(const std::string& command, const std::vector<std::string>& arguments,
              const std::filesystem::path& log_file,
              const std::function<void(std::string_view)>& on_line) const;

 private:
  std::filesystem::path executable_;
  std::map<std::string, std::set<std::string>> options_;  // by command
  std::optional<std::array<int, 3>> version_;
};

// Throws the InputError of a failed step: the command, COLMAP's error message, the log file.
[[noreturn]] void ThrowStepFailed(const std::string& command, const ColmapProgram::Outcome& outcome,
                                  const std::filesystem::path& log_file);

struct StepProgress {
  int done = 0;   // 0 where the line reports no progress
  int total = 0;  // 0 where it is unknown
};
// Parses the progress of a step from a line of output: "Processed file [12/50]", "Matching block
// [1/2, 2/2]", "Matching image [3/50]" or "Registering image #12 (34)", and what newer versions log
// instead: a prefix, "Processing", "(num_reg_frames=34)".
StepProgress ParseProgress(std::string_view line);

}  // namespace nerf::sfm
