#include "sfm/step_ledger.h"

#include <fstream>
#include <utility>

#include "nerf/base/atomic_file.h"

namespace nerf::sfm {

using nlohmann::json;

StepLedger::StepLedger(std::filesystem::path file) : file_(std::move(file)) {
  std::ifstream stream(file_);
  const json read = json::parse(stream, nullptr, /*allow_exceptions=*/false);
  if (!read.is_array()) return;
  for (const json& entry : read) {
    if (!entry.is_object() || !entry.contains("step") || !entry["step"].is_string() ||
        !entry.contains("inputs")) {
      return;  // the entries before the damaged one are valid
    }
    steps_.push_back(entry);
  }
}

std::size_t StepLedger::Find(const std::string& step) const {
  std::size_t i = 0;
  while (i < steps_.size() && steps_[i]["step"] != step) ++i;
  return i;
}

StepLedger::State StepLedger::StateOf(const std::string& step, const json& inputs) const {
  const std::size_t i = Find(step);
  if (i == steps_.size()) return State::kNew;
  if (steps_[i]["inputs"] != inputs) return State::kChanged;
  return steps_[i].contains("seconds") ? State::kDone : State::kBegun;
}

void StepLedger::Begin(const std::string& step, const json& inputs) {
  const std::size_t i = Find(step);
  steps_.erase(steps_.begin() + static_cast<std::ptrdiff_t>(i), steps_.end());
  steps_.push_back({{"step", step}, {"inputs", inputs}});
  Write();
}

void StepLedger::Finish(const std::string& step, double seconds) {
  steps_.at(Find(step))["seconds"] = seconds;
  Write();
}

double StepLedger::Seconds(const std::string& step) const {
  const std::size_t i = Find(step);
  if (i == steps_.size()) return 0;
  const auto seconds = steps_[i].find("seconds");
  return seconds != steps_[i].end() && seconds->is_number() ? seconds->get<double>() : 0.0;
}

void StepLedger::Write() const {
  // File names may be invalid UTF-8.
  WriteFileAtomically(file_, steps_.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

}  // namespace nerf::sfm
