#pragma once

#include <string>
#include <vector>

namespace nerf {

// Whether a scene calls for an effect, and what says so.
struct Verdict {
  // Its key in the configuration's effects; "alpha" and "hdr" have none, and "near" is
  // march.near_distance.
  std::string effect;
  std::string evidence;  // what was measured, in words with its figure
  double figure = 0;     // the same as a number, in the unit of the threshold
  double threshold = 0;  // from which on the scene calls for it
  bool decided = false;  // whether there is any evidence
  bool on = false;
  bool tried = false;  // by a trial, after which there is no more to ask

  // From 0 at the threshold to 1 at twice or half of it. Facts are sure.
  double Sure() const;
  // Whether the evidence is to be acted on as it is; what is in between can be tried.
  bool IsSure() const { return tried || Sure() >= 0.5; }

  // What the configuration says for it, as --set does: "effects.robust={}".
  std::string assignment = {};
};

// What needs no threshold.
//   setting  JSON of the effect's block where it is on
Verdict Fact(const std::string& effect, bool on, double figure, const std::string& evidence,
             const std::string& setting = "{}");

// On from the threshold on.
Verdict Measured(const std::string& effect, double figure, double threshold,
                 const std::string& evidence);

// Nothing tells.
Verdict Undecided(const std::string& effect, const std::string& evidence);

// What a trial has decided: on where it was worth so many decibels. Sure: there is no more to ask.
Verdict Tried(Verdict verdict, double psnr_with, double psnr_without, double worth_it);

// What is judged as effects are and is none: properties of the photographs, and where rays begin.
inline constexpr char kAlpha[] = "alpha";
inline constexpr char kHdr[] = "hdr";
inline constexpr char kNearPlane[] = "near";
inline constexpr char kNearKey[] = "march.near_distance";

// Turns an effect on or off, by its key and JSON for its block ("{}", "null"), as --set does.
std::string EffectAssignment(const std::string& effect, const std::string& setting);

// A verdict as a line, and a table of them.
std::string RowOf(const Verdict& verdict);
std::string TableOf(const std::vector<Verdict>& verdicts);

}  // namespace nerf
