#pragma once

namespace nerf {

struct CaptureEvidence;
struct Verdict;

// The description of an effect; its options and its verdict are in the same file. Where it has
// trained parameters, its module is in field/.
// EffectsOptions (effects.h) lists all effects.
struct EffectDescriptor {
  const char* name;      // key in the configuration's `effects`, and in --effects
  const char* old_name;  // alias, accepted for one more version; null: none
  const char* help;      // what it simulates, one line
  const char* stage;     // of the path from a ray to a pixel (README.md), at which it runs
  // Prefix of its trained parameters in a checkpoint; null: it has none.
  const char* parameters = nullptr;
  // Decides whether a capture calls for it.
  Verdict (*judge)(const CaptureEvidence& evidence);
  // Steps of a paired trial, and whether to try the effect even without any evidence.
  int trial_steps = 200;
  bool tried_without_evidence = false;
  // Whether it has trained parameters per photograph, which held-out photographs lack: it is then
  // measured on the right halves of photographs whose left halves are trained on.
  bool measured_on_halves = false;
};

}  // namespace nerf
