#pragma once

#include "nerf/inspect/evidence.h"
#include "nerf/inspect/verdict.h"

namespace nerf {

// What the program knows of an effect beside its options and its algorithm, which stand in the same
// file. EffectsOptions (effects.h) lists all of them.
struct EffectDescriptor {
  const char* name;      // its key in the configuration's `effects`, and in --effects
  const char* old_name;  // accepted for one version more; null where it had no other
  const char* help;      // what it simulates, one line
  const char* hook;      // where it stands in a ray's path
  // Prefix of its trained parameters in a checkpoint; null where it has none.
  const char* parameters = nullptr;
  // Whether a capture calls for it.
  Verdict (*judge)(const CaptureEvidence& evidence);
  // Steps of a paired trial, and whether one is worth its time where there is no evidence at all.
  int trial_steps = 200;
  bool tried_without_evidence = false;
  // Whether it learns something of each photograph that held-out photographs lack: it is then
  // measured on halves of photographs whose other halves are trained on.
  bool measured_on_halves = false;
};

}  // namespace nerf
