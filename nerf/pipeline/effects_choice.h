#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "nerf/config/config.h"
#include "nerf/effects/inspection.h"
#include "nerf/model/model.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// Which effects a run simulates that nobody has named, what said so, and what it took to find out.
class EffectsChoice {
 public:
  // As configured.
  EffectsChoice() = default;
  // Looks at the capture, and acts on what is sure.
  //   named  effects that a person decides, as in `asked`
  EffectsChoice(const PosedImages& posed, const Config& asked, std::set<std::string> named);

  // The exposures that are known, of the photographs that are trained on; empty where they are not.
  //   posed  that was looked at
  std::vector<double> StopsOfTrained(const PosedImages& posed, const Dataset& data) const;

  // Where photographs turned out to have alpha, of which too little was seen to tell when a few
  // were looked at: then no background is learned, and contracted space holds what is far.
  void HeedAlpha();

  // Whether an effect is to be tried.
  bool IsOpen(const std::string& effect) const;

  // Tries what the look left open (nerf/commands/effects_trials.h), and prints it.
  //   seconds_left  of the time budget, where there is one
  void Try(const Config& config, const SceneFacts& scene, double seconds_left, Dataset& data);

  // What was decided so far, to be configured.
  const std::vector<std::string>& Assignments() const { return assignments_; }
  const Inspection& GetInspection() const { return inspection_; }

  // The verdicts, as a table; a line where there was nothing to tell from.
  void Print() const;

  // RUN/effects.json: the verdicts with their evidence, who decided, and what is simulated.
  void Write(const Config& config, const std::filesystem::path& run) const;

 private:
  std::set<std::string> named_;
  Inspection inspection_;
  std::vector<std::string> assignments_;
  double seconds_ = 0, trial_seconds_ = 0;
};

}  // namespace nerf
