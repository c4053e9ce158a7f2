#pragma once

#include <string>

#include "nerf/config/config.h"
#include "nerf/model/model.h"
#include "nerf/scene/dataset.h"

namespace nerf {

// What a short training came to.
struct TrialResult {
  double psnr = 0;            // dB, on validation photographs, each at its own exposure
  double seconds = 0;         // of the whole trial
  double seconds_a_step = 0;  // the median, so that a neighbour on the machine counts little
  double megabytes = 0;       // of parameters, with their gradients and Adam's moments
};

// What a model's training holds: parameters, their gradients, and Adam's two moments.
double MegabytesOf(const Model& model);

// Trains a new model for so many steps, with the learning rate at its last value in the end, and
// keeps nothing. The same seed draws the same rays, so that two trials differ by their
// configurations alone. Needs validation photographs.
TrialResult TryConfig(Config config, const SceneFacts& scene, const Dataset& data, int steps);

// What a step of such a training will take, with its share of what else a trial does, by the first
// ones.
//   steps  of the training
double EstimateSecondsOfAStep(Config config, const SceneFacts& scene, const Dataset& data,
                              int steps);

// The configuration with one effect on or off. setting: JSON of its block, "{}" or "null".
Config WithEffect(const Config& config, const std::string& effect, const std::string& setting);

// Whether the configuration simulates an effect.
bool Simulates(const Config& config, const std::string& effect);

}  // namespace nerf
