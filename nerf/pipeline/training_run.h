#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nerf/base/stopwatch.h"

namespace nerf {

// What a person asks of nerf train.
struct TrainArguments {
  std::string input;
  std::string output;
  std::string preset = "balanced";
  bool preset_given = false;
  std::vector<std::string> assignments;
  std::string effects = "auto";
  std::optional<int> downscale;
  std::optional<double> time_budget;  // seconds
  std::optional<double> target_psnr;  // dB
  int threads = 0;
  bool resume = false;
};

// From an input to a trained run, or from where a run was left to its end; prints what a person is
// told on the way.
//   watch  started with the command
// Throw InputError.
void StartRun(const TrainArguments& arguments, int threads, const Stopwatch& watch);
void ResumeRun(const TrainArguments& arguments, int threads, const Stopwatch& watch);

}  // namespace nerf
