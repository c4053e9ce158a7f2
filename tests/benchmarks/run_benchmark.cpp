// One whole run as a person types it: nerf train, then nerf eval at two qualities. Prints a line
// and writes a JSON file:  run_benchmark PROGRAM INPUT RUN OUTPUT.json [FLAGS OF TRAIN ...]
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

extern char** environ;

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

struct Outcome {
  double seconds = 0;
  double peak_megabytes = 0;
};

// Runs a program to its end. Its standard output goes to a file.
Outcome RunProgram(std::vector<std::string> arguments, const fs::path& output) {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const auto begin = std::chrono::steady_clock::now();
  pid_t child = 0;
  if (posix_spawnp(&child, pointers[0], &actions, nullptr, pointers.data(), environ) != 0) {
    throw std::runtime_error(arguments[0] + ": cannot be started");
  }
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  rusage usage{};
  if (wait4(child, &status, 0, &usage) != child || status != 0) {
    throw std::runtime_error(arguments[0] + " " + arguments[1] + ": failed");
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  return {elapsed.count(), static_cast<double>(usage.ru_maxrss) / 1024};
}

json ReadJson(const fs::path& path) {
  std::ifstream file(path);
  return json::parse(file);
}

// Training seconds at which the validation PSNR first was as high as each mark.
json SecondsToReach(const fs::path& metrics) {
  json reached = json::object();
  std::ifstream file(metrics);
  for (std::string text; std::getline(file, text);) {
    const json line = json::parse(text);
    if (!line.contains("validation_psnr")) continue;
    for (int mark = 20; mark <= line["validation_psnr"].get<double>(); ++mark) {
      const std::string key = std::to_string(mark);
      if (!reached.contains(key)) reached[key] = line["seconds"];
    }
  }
  return reached;
}

void Run(const std::vector<std::string>& arguments) {
  const std::string &program = arguments[0], &input = arguments[1];
  const fs::path run = arguments[2], output = arguments[3];
  fs::remove_all(run);
  fs::create_directories(run.parent_path());
  std::vector<std::string> train = {program, "train", input, "-o", run.string()};
  train.insert(train.end(), arguments.begin() + 4, arguments.end());
  const Outcome training = RunProgram(train, run.string() + ".log");

  json result = {{"input", input},
                 {"flags", std::vector<std::string>(arguments.begin() + 4, arguments.end())},
                 {"wall_seconds", training.seconds},
                 {"peak_megabytes", training.peak_megabytes},
                 {"seconds_to_validation_psnr", SecondsToReach(run / "metrics.jsonl")}};
  for (const char* quality : {"1", "0.25"}) {
    RunProgram({program, "eval", run.string(), "--quality", quality, "--json"},
               run.string() + ".eval.json");
    const json eval = ReadJson(run.string() + ".eval.json");
    result["training_seconds"] = eval["training_seconds"];
    result["step"] = eval["step"];
    result["quality"][quality] = {{"psnr", eval["psnr"]},
                                  {"ssim", eval["ssim"]},
                                  {"seconds_per_frame", eval["seconds_per_frame"]}};
  }
  std::ofstream(output) << result.dump(2) << "\n";
  const json &exact = result["quality"]["1"], &fast = result["quality"]["0.25"];
  std::printf(
      "%-28s %6d steps %7.1f s training %7.1f s wall %6.0f MB  %.2f dB %.4f  %.2f s a frame"
      "  (quality 0.25: %.2f dB %.2f s)\n",
      output.stem().c_str(), result["step"].get<int>(), result["training_seconds"].get<double>(),
      training.seconds, training.peak_megabytes, exact["psnr"].get<double>(),
      exact["ssim"].get<double>(), exact["seconds_per_frame"].get<double>(),
      fast["psnr"].get<double>(), fast["seconds_per_frame"].get<double>());
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() < 4) {
    std::fputs("usage: run_benchmark PROGRAM INPUT RUN OUTPUT.json [FLAGS OF TRAIN ...]\n", stderr);
    return 2;
  }
  try {
    Run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "run_benchmark: %s\n", error.what());
    return 1;
  }
  return 0;
}
