#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>
#include <thread>

namespace nerf::test {

struct ProgramResult {
  int exit_status = -1;
  std::string output;  // standard output and standard error
};

// Runs the built program with `arguments` in a shell, after the shell commands in `before`.
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

// Runs the program until a file exists, and then kills it with SIGKILL.
inline void KillWhenExists(const std::filesystem::path& file, const std::string& arguments) {
  const std::string command = "exec " + std::string(NERF_PROGRAM) + " " + arguments;
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", (command + " >/dev/null 2>&1").c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  while (!std::filesystem::exists(file) && waitpid(child, &status, WNOHANG) == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status)) << "the run finished before it could be killed";
}

}  // namespace nerf::test
