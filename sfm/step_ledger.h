#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace nerf::sfm {

// Which steps of a long job are finished, kept in a JSON file, so that a second call goes on where
// the first one ended. Steps depend on one another in the order in which they are begun: beginning
// one forgets those that came after it. A missing or damaged file counts as nothing done.
class StepLedger {
 public:
  explicit StepLedger(std::filesystem::path file);

  enum class State {
    kNew,      // never begun since the steps before it last ran
    kChanged,  // begun or finished, but from other inputs
    kBegun,    // begun from these inputs, not finished
    kDone,     // finished from these inputs
  };
  // inputs: all that the result depends on and no step before it covers.
  State StateOf(const std::string& step, const nlohmann::json& inputs) const;

  // Both write the file, whole or not at all; throw InputError when they cannot.
  void Begin(const std::string& step, const nlohmann::json& inputs);
  void Finish(const std::string& step, double seconds);

  // Of a finished step; 0 of others.
  double Seconds(const std::string& step) const;

 private:
  std::size_t Find(const std::string& step) const;
  void Write() const;

  std::filesystem::path file_;
  nlohmann::json steps_ = nlohmann::json::array();
};

}  // namespace nerf::sfm
