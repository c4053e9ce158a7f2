#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "nerf/model/representation_record.h"
#include "nerf/pipeline/gaussian_training.h"
#include "nerf/train/trainer.h"

namespace nerf {

struct RepresentationsTrained {
  TrainSummary field;
  RepresentationRecord record;
  bool finished = false;        // both; false: stopped on request, can be resumed
  bool reached_target = false;  // train.target_psnr, by either
};

// Why no Gaussians can be fitted to a capture, or `auto` has nothing to compare them by; empty:
// they can.
std::string WhyNoGaussians(const Config& config, const Dataset& data);

// Trains a field, and Gaussians beside it where train.representation asks for them or a trial
// promises that they will be better (TryGaussians). With a time budget they divide it
// (splats.share); otherwise the field takes all its steps, and the Gaussians splats.steps, but at
// most as many. Writes what Trainer::Run writes, RUN/representation.json and RUN/splats.nerf, and
// goes on where an interrupted run stands there.
RepresentationsTrained TrainRepresentations(Trainer& trainer, const Dataset& data,
                                            const std::filesystem::path& run,
                                            const std::atomic<bool>& stop,
                                            const PipelineListener& listener);

}  // namespace nerf
