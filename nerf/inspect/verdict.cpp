#include "nerf/inspect/verdict.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace nerf {

double Verdict::Confidence() const {
  if (!decided) return 0;
  if (threshold <= 0 || figure <= 0) return 1;
  return std::min(most_confidence, std::fabs(std::log2(figure / threshold)));
}

Verdict Fact(const std::string& effect, bool on, double figure, const std::string& evidence,
             const std::string& setting) {
  Verdict verdict;
  verdict.effect = effect;
  verdict.evidence = evidence;
  verdict.figure = figure;
  verdict.decided = true;
  verdict.on = on;
  verdict.assignment = EffectAssignment(effect, on ? setting : "null");
  return verdict;
}

Verdict Measured(const std::string& effect, double figure, double threshold,
                 const std::string& evidence) {
  Verdict verdict = Fact(effect, figure >= threshold, figure, evidence);
  verdict.threshold = threshold;
  return verdict;
}

Verdict Undecided(const std::string& effect, const std::string& evidence) {
  Verdict verdict;
  verdict.effect = effect;
  verdict.evidence = evidence;
  return verdict;
}

Verdict FromTrial(Verdict verdict, double psnr_with, double psnr_without, double required_gain) {
  verdict.figure = psnr_with - psnr_without;
  verdict.threshold = required_gain;
  verdict.decided = verdict.from_trial = true;
  verdict.most_confidence = 1;
  verdict.on = verdict.figure >= required_gain;
  verdict.assignment = EffectAssignment(verdict.effect, verdict.on ? "{}" : "null");
  verdict.evidence = fmt::format("{}; trial: {:.2f} dB with it, {:.2f} dB without",
                                 verdict.evidence, psnr_with, psnr_without);
  return verdict;
}

std::string EffectAssignment(const std::string& effect, const std::string& setting) {
  return "effects." + effect + "=" + setting;
}

std::string RowOf(const Verdict& v) {
  const std::string confidence = v.decided ? fmt::format("{:.0f} %", 100 * v.Confidence()) : "-";
  const char* const word = !v.decided ? "undecided" : v.on ? "on" : "off";
  return fmt::format("{:<18} {:<9} {:>10}  {}\n", v.effect, word, confidence, v.evidence);
}

std::string TableOf(const std::vector<Verdict>& verdicts) {
  std::string text =
      fmt::format("{:<18} {:<9} {:>10}  {}\n", "effect", "verdict", "confidence", "evidence");
  for (const Verdict& verdict : verdicts) text += RowOf(verdict);
  return text;
}

}  // namespace nerf
