#include "nerf/selfcheck/selfcheck.h"

#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "nerf/commands/commands.h"
#include "sfm/progress.h"

namespace nerf {
namespace {

constexpr int kExitWrongHere = 1;

void PrintJson(const std::vector<CaseResult>& results, bool passed) {
  nlohmann::json rows = nlohmann::json::array();
  for (const CaseResult& result : results) {
    const NumericCase& c = *result.numeric_case;
    nlohmann::json row = {{"case", c.name},
                          {"measures", c.error},
                          {"bound", c.bound},
                          {"level", result.level},
                          {"passed", result.Passed()}};
    // JSON has no infinity: a claim that does not hold has no error.
    row["error"] = std::isfinite(result.error) ? nlohmann::json(result.error) : nlohmann::json();
    rows.push_back(row);
  }
  fmt::print("{}\n", nlohmann::json{{"passed", passed}, {"cases", rows}}.dump(2));
}

// A line a case: the worst of its SIMD levels, and that level's name.
void PrintTable(const std::vector<CaseResult>& results) {
  fmt::print("{:<42}  {:>8}  {:>8}  {:<6}  {:<4}  {}\n", "case", "bound", "error", "worst", "",
             "measures");
  for (auto first = results.begin(); first != results.end();) {
    const auto last = std::find_if(first, results.end(), [&](const CaseResult& result) {
      return result.numeric_case != first->numeric_case;
    });
    // One that failed at any level comes first.
    const auto& worst = *std::max_element(first, last, [](const auto& a, const auto& b) {
      return a.Passed() != b.Passed() ? a.Passed() : a.error < b.error;
    });
    const NumericCase& c = *worst.numeric_case;
    fmt::print("{:<42}  {:>8.1e}  {:>8.1e}  {:<6}  {:<4}  {}\n", c.name, c.bound, worst.error,
               worst.level.empty() ? "-" : worst.level, worst.Passed() ? "ok" : "FAIL", c.error);
    first = last;
  }
}

void RunSelfcheck(bool json) {
  const std::vector<NumericCase> cases = NumericCases();
  sfm::ProgressLine progress("checking", static_cast<std::int64_t>(cases.size()));
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
  if (failed > 0) throw CLI::RuntimeError(kExitWrongHere);
}

}  // namespace

void AddSelfcheckCommand(CLI::App& app) {
  auto* command = app.add_subcommand(
      "selfcheck", "is the arithmetic right on this processor? in under a minute");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "print JSON, with a row for each SIMD level");
  command->footer(
      "Measures the hard cases of the numerics against slow, exact forms, on every SIMD level "
      "that\n"
      "this processor has. Exit status 1 where one is out of its bound.\n"
      "Examples:\n"
      "  nerf selfcheck\n"
      "  nerf selfcheck --json > selfcheck.json");
  command->callback([json] { RunSelfcheck(*json); });
}

}  // namespace nerf
