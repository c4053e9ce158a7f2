#pragma once

#include "nerf/config/config.h"
#include "nerf/model/scene_facts.h"
#include "nerf/scene/dataset.h"

namespace nerf {

// The result of a training of a few hundred steps that keeps nothing.
struct ShortTraining {
  double psnr = 0;            // dB, on validation photographs, each at its own exposure
  double seconds = 0;         // of all of it
  double seconds_a_step = 0;  // the median, so that other work on the machine counts little
  double megabytes = 0;       // of parameters, with their gradients and Adam's moments
};

// Trains a new model for so many steps, to the end of its learning rate schedule. The same seed
// draws the same rays, so that two trainings differ by their configurations alone. Needs validation
// photographs. Throws NonFiniteError where the training diverges.
ShortTraining TrainShortly(const Config& config, const SceneFacts& scene, const Dataset& data,
                           int steps);

// What a step of such a training will take, with its share of set-up and measurement, by the first
// ones.
//   steps  of the training
double EstimateSecondsOfAStep(const Config& config, const SceneFacts& scene, const Dataset& data,
                              int steps);

}  // namespace nerf
