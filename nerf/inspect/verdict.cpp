#include "nerf/inspect/verdict.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace nerf {

double Verdict::Sure() const {
  if (!decided) return 0;
  if (threshold == 0 || figure <= 0) return 1;
  return std::min(1.0, std::fabs(std::log2(figure / threshold)));
}

std::string TableOf(const std::vector<Verdict>& verdicts) {
  std::string text =
      fmt::format("{:<11} {:<9} {:>5}  {}\n", "effect", "verdict", "sure", "evidence");
  for (const Verdict& v : verdicts) {
    const std::string sure = v.decided ? fmt::format("{:.0f} %", 100 * v.Sure()) : "-";
    const char* const word = !v.decided ? "undecided" : v.on ? "on" : "off";
    text += fmt::format("{:<11} {:<9} {:>5}  {}\n", v.effect, word, sure, v.evidence);
  }
  return text;
}

}  // namespace nerf
