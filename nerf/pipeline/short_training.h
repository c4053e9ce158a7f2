#pragma once

#include "nerf/config/config.h"
#include "nerf/model/scene_facts.h"
#include "nerf/scene/dataset.h"

namespace nerf {

// The result of a training of a few hundred steps whose model is discarded.
struct ShortTraining {
  double psnr = 0;              // dB, on validation photographs, each at its own exposure
  double seconds = 0;           // total
  double seconds_per_step = 0;  // median, which is robust to other load on the machine
  double megabytes = 0;         // of parameters, with their gradients and Adam's moments
};

// Trains a new model for `steps` steps, with the whole learning-rate schedule. Two trainings with
// the same seed use the same rays, so that they differ only by their configurations. Needs
// validation photographs. Throws NonFiniteError if training diverges.
ShortTraining TrainShortly(const Config& config, const SceneFacts& scene, const Dataset& data,
                           int steps);

// Estimates the seconds per step of TrainShortly, including set-up and validation, from a few
// steps.
//   steps  of the whole training
double EstimateSecondsPerStep(const Config& config, const SceneFacts& scene, const Dataset& data,
                              int steps);

}  // namespace nerf
