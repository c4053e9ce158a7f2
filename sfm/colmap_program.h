#pragma once

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace nerf::sfm {

// The COLMAP program that is installed here, version 3.8 or later, run without a display.
// COLMAP 3.13 renamed options without keeping the old names, so the program itself is asked.
class ColmapProgram {
 public:
  // Looks `colmap` up in PATH. Throws InputError that says how to install it.
  static ColmapProgram Find();

  explicit ColmapProgram(std::filesystem::path executable) : executable_(std::move(executable)) {}

  // The first of the names that `colmap COMMAND -h` lists; an empty string where it lists none.
  // Asks once a command.
  std::string KnownOption(const std::string& command, std::initializer_list<const char*> names);

  struct Outcome {
    int exit_code = 0;
    std::string last_line;  // of what it said: the error where there is one
  };

  // Runs `colmap COMMAND ARGUMENTS...`; all it says goes to `log_file`, and line by line to
  // `on_line`. The child does not outlive this process, nor an exception from `on_line`.
  // Throws InputError when it cannot be started, when the log cannot be written, or when a signal
  // ended it (Ctrl-C, or the system for want of memory).
  Outcome Run(const std::string& command, const std::vector<std::string>& arguments,
              const std::filesystem::path& log_file,
              const std::function<void(std::string_view)>& on_line) const;

 private:
  std::filesystem::path executable_;
  std::map<std::string, std::set<std::string>> options_;  // by command
};

// The error that an unsuccessful step ends in: the step, what COLMAP said last, the log file.
[[noreturn]] void ThrowStepFailed(const std::string& command, const ColmapProgram::Outcome& outcome,
                                  const std::filesystem::path& log_file);

// How far a step is, as one line of its output tells; `done` is 0 where the line tells nothing.
// Understands "Processed file [12/50]", "Matching block [1/2, 2/2]", "Matching image [3/50]" and
// "Registering image #12 (34)", with or without the prefix that newer versions log.
struct StepProgress {
  int done = 0;
  int total = 0;  // 0 where the line does not tell
};
StepProgress ParseProgress(std::string_view line);

}  // namespace nerf::sfm
