#include "nerf/selfcheck/selfcheck.h"

#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "nerf/base/progress.h"
#include "nerf/commands/commands.h"

namespace nerf {
namespace {

constexpr int kExitFailed = 1;

void PrintJson(const std::vector<CaseResult>& results, bool passed) {
  nlohmann::json rows = nlohmann::json::array();
  for (const CaseResult& result : results) {
    const NumericCase& c = *result.numeric_case;
    nlohmann::json row = {{"case", c.name},
                          {"measures", c.error},
                          {"bound", c.bound},
                          {"level", result.level},
                          {"passed", result.Passed()}};
    // JSON has no infinity: a failed claim without a measured error has null.
    row["error"] = std::isfinite(result.error) ? nlohmann::json(result.error) : nlohmann::json();
    rows.push_back(row);
  }
  fmt::print("{}\n", nlohmann::json{{"passed", passed}, {"cases", rows}}.dump(2));
}

// Prints a line per case, with its error at each SIMD level; the first column is for cases without
// SIMD code.
void PrintTable(const std::vector<CaseResult>& results) {
  std::vector<std::string> levels = {""};
  for (const CaseResult& result : results) {
    if (std::ranges::find(levels, result.level) == levels.end()) levels.push_back(result.level);
  }
  fmt::print("{:<41}  {:>7}", "case", "bound");
  for (const std::string& level : levels) fmt::print("  {:>7}", level.empty() ? "plain" : level);
  fmt::print("\n");
  for (auto first = results.begin(); first != results.end();) {
    const auto last = std::find_if(first, results.end(), [&](const CaseResult& result) {
      return result.numeric_case != first->numeric_case;
    });
    fmt::print("{:<41}  {:>7.1e}", first->numeric_case->name, first->numeric_case->bound);
    for (const std::string& level : levels) {
      const auto found = std::find_if(
          first, last, [&level](const CaseResult& result) { return result.level == level; });
      fmt::print("  {:>7}", found == last ? "" : fmt::format("{:.1e}", found->error));
    }
    const bool passed = std::all_of(first, last, [](const auto& r) { return r.Passed(); });
    fmt::print("  {}\n", passed ? "ok" : "FAIL");
    first = last;
  }
}

void RunSelfcheck(bool json) {
  const std::vector<NumericCase> cases = NumericCases();
  ProgressLine progress("checking", static_cast<std::int64_t>(cases.size()));
  const std::vector<CaseResult> results = MeasureCases(cases, [&](std::int64_t measured) {
    progress.Update(measured, cases[static_cast<std::size_t>(measured) - 1].name);
  });
  progress.Finish();
  const auto failed = std::ranges::count_if(results, [](const auto& r) { return !r.Passed(); });
  if (json) {
    PrintJson(results, failed == 0);
  } else {
    PrintTable(results);
    fmt::print("{} of {} pass\n", std::ssize(results) - failed, results.size());
  }
  if (failed > 0) throw CLI::RuntimeError(kExitFailed);
}

}  // namespace

void AddSelfcheckCommand(CLI::App& app) {
  auto* command =
      app.add_subcommand("selfcheck", "Checks the numerics on this processor, in under a minute");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "print JSON, with a description of each measurement");
  command->footer(
      "Compares the hard cases of the numerics with slow, exact reference code, at every SIMD "
      "level\n"
      "of this processor. Exit status 1 if an error exceeds its bound.\n"
      "Examples:\n"
      "  nerf selfcheck\n"
      "  nerf selfcheck --json > selfcheck.json");
  command->callback([json] { RunSelfcheck(*json); });
}

}  // namespace nerf
