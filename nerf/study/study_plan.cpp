#include "nerf/study/study_plan.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace nerf {
namespace {

// Training times, relative to the shortest.
constexpr double kShort = 1, kMiddle = 3, kLong = 9;

constexpr double kShortestTraining = 1;  // seconds

}  // namespace

std::vector<StudySetting> StudySettings(int downscale) {
  const std::vector<std::string> splats = {"train.representation=splats"};
  return {
      {"fast-short", "fast", {}, kShort},
      {"balanced-short", "balanced", {}, kShort},
      {"splats-short", "fast", splats, kShort},
      {"fast-middle", "fast", {}, kMiddle},
      {"balanced-middle", "balanced", {}, kMiddle},
      {"small-table", "balanced", {"encoding.log2_table_size=15"}, kMiddle},
      {"twelve-levels", "balanced", {"encoding.levels=12"}, kMiddle},
      {"narrow", "balanced", {"field.hidden_width=32"}, kMiddle},
      {"few-samples", "balanced", {"proposal.samples=16", "march.steps_per_unit=64"}, kMiddle},
      {"bfloat16", "balanced", {"train.precision=bfloat16"}, kMiddle},
      {"half-resolution", "balanced", {fmt::format("data.downscale={}", 2 * downscale)}, kMiddle},
      {"splats-middle", "fast", splats, kMiddle},
      {"balanced-long", "balanced", {}, kLong},
      {"accurate-long", "accurate", {}, kLong},
      {"splats-long", "fast", splats, kLong},
  };
}

double SecondsOfSetting(const std::vector<StudySetting>& settings, std::size_t next, double left,
                        double overhead) {
  double shares = 0;
  for (std::size_t i = next; i < settings.size(); ++i) shares += settings[i].share;
  const double training = left - overhead * static_cast<double>(settings.size() - next);
  return std::max(kShortestTraining, training * settings[next].share / shares);
}

}  // namespace nerf
