#pragma once

#include "nerf/config/train_options.h"

namespace nerf {

// The factor by which photographs are reduced where the user does not say it: to the resolution
// that a training of this length can learn.
//   longest_side  of the photographs, pixels
//   seconds       of training
//   returns       1 or more
int DownscaleFor(int longest_side, double seconds);

// How long a training takes, roughly.
double TrainingSeconds(const TrainOptions& options);

}  // namespace nerf
