#pragma once

#include <string>
#include <vector>

namespace nerf {

// Whether a scene needs an effect, and the evidence.
struct Verdict {
  // The key among the configuration's effects. "alpha" and "hdr" have none; "near" stands for
  // march.near_distance.
  std::string effect;
  std::string evidence;  // the measurement in words, with its figure
  double figure = 0;     // the measurement, in the unit of the threshold
  double threshold = 0;  // at and above which the scene needs the effect
  bool decided = false;  // whether there is any evidence
  bool on = false;
  bool from_trial = false;     // a trial run has decided it
  double most_confidence = 1;  // less where the evidence may be one-sided

  // 0 at the threshold, 1 (or most_confidence) at twice or half of it and beyond; 1 for facts, 0
  // without evidence.
  double Confidence() const;
  // Whether the verdict is applied as it is; others can be decided by a trial.
  bool IsConclusive() const { return from_trial || Confidence() >= 0.5; }

  // The setting that applies the verdict, as for --set: "effects.robust={}".
  std::string assignment = {};
};

// A verdict that needs no threshold.
//   setting  JSON of the effect's block where it is on
Verdict Fact(const std::string& effect, bool on, double figure, const std::string& evidence,
             const std::string& setting = "{}");

// On where the figure is at or above the threshold.
Verdict Measured(const std::string& effect, double figure, double threshold,
                 const std::string& evidence);

// There is no evidence.
Verdict Undecided(const std::string& effect, const std::string& evidence);

// The verdict of a trial: on where the effect gained at least `required_gain` dB. Conclusive.
Verdict FromTrial(Verdict verdict, double psnr_with, double psnr_without, double required_gain);

// What is judged as effects are and is none: properties of the photographs, and where rays begin.
inline constexpr char kAlpha[] = "alpha";
inline constexpr char kHdr[] = "hdr";
inline constexpr char kNearPlane[] = "near";
inline constexpr char kNearKey[] = "march.near_distance";

// The setting, as for --set, that turns an effect on or off.
//   setting  JSON of its block: "{}" turns it on with its defaults, "null" off
std::string EffectAssignment(const std::string& effect, const std::string& setting);

// A verdict as a line of a table, and the table of several.
std::string RowOf(const Verdict& verdict);
std::string TableOf(const std::vector<Verdict>& verdicts);

}  // namespace nerf
