#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace nerf::sfm {

// Records in a JSON file which steps of a long job are finished, so that a second call continues
// where the first one stopped. Each step depends on those begun before it: beginning a step removes
// the records of those after it. A missing or damaged file counts as no step finished.
class StepLedger {
 public:
  explicit StepLedger(std::filesystem::path file);

  enum class State {
    kNew,      // not begun since the steps before it last ran
    kChanged,  // begun or finished, but from other inputs
    kBegun,    // begun from these inputs, not finished
    kDone,     // finished from these inputs
  };
  //   inputs  all inputs of the step's result except the results of earlier steps
  State StateOf(const std::string& step, const nlohmann::json& inputs) const;

  // Both write the file atomically. Throw InputError when that is not possible.
  void Begin(const std::string& step, const nlohmann::json& inputs);
  void Finish(const std::string& step, double seconds);

  // The duration of a finished step; 0 for others.
  double Seconds(const std::string& step) const;

 private:
  std::size_t Find(const std::string& step) const;
  void Write() const;

  std::filesystem::path file_;
  nlohmann::json steps_ = nlohmann::json::array();
};

}  // namespace nerf::sfm
