#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace nerf::test {

struct ProgramResult {
  int exit_status = -1;
  std::string output;  // standard output and standard error
};

// Runs the built program with the shell's words in `arguments`, as a person types them, after the
// shell commands in `before`.
inline ProgramResult RunNerf(const std::string& arguments, const std::string& before = "") {
  ProgramResult result;
  const std::string command = before + NERF_PROGRAM + " " + arguments + " 2>&1";
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return result;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    result.output.append(buffer.data(), n);
  }
  const int status = pclose(pipe);
  result.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

}  // namespace nerf::test
