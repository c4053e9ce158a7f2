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

// Runs the built program with the shell's words in `arguments`, as a person types them.
inline ProgramResult RunNerf(const std::string& arguments) {
  ProgramResult result;
  std::FILE* pipe = popen((std::string(NERF_PROGRAM) + " " + arguments + " 2>&1").c_str(), "r");
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
