#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <vector>

#include "nerf/field/libtorch.h"
#include "nerf/model/checkpoint.h"
#include "nerf/model/run_folder.h"
#include "nerf/train/trainer.h"
#include "tests/support/scratch_folder.h"

namespace nerf::test {

inline const std::atomic<bool> never_stop = false;

// A configuration that trains a simple scene in seconds.
inline Config TinyConfig(std::int64_t steps, const std::vector<std::string>& changes = {}) {
  std::vector<std::string> assignments = {"encoding.log2_table_size=12",
                                          "encoding.max_resolution=64",
                                          "field.hidden_width=16",
                                          "proposal.encoding.log2_table_size=11",
                                          "proposal.anneal_steps=50",
                                          "occupancy.resolution=32",
                                          "occupancy.coarse_to_fine_steps=100",
                                          "march.steps_per_unit=48",
                                          "train.max_rays_per_batch=512",
                                          "train.samples_per_batch=8192",
                                          "train.checkpoint_every=1000",
                                          "train.validate_every=1000",
                                          "train.steps=" + std::to_string(steps)};
  assignments.insert(assignments.end(), changes.begin(), changes.end());
  return LoadConfig("base", assignments);
}

// Trains a model. Checks that training finishes and that the checkpoint is finite.
inline Model Trained(const Config& config, const SceneFacts& scene, const Dataset& data) {
  const ScratchFolder run;
  Trainer trainer(config, scene, data, run.path());
  EXPECT_TRUE(trainer.Run(never_stop).finished);
  for (const auto& [name, tensor] : ReadRunCheckpoint(run.path()).tensors) {
    EXPECT_TRUE(torch::isfinite(tensor).all().item<bool>()) << name;
  }
  return trainer.GetModel();
}

}  // namespace nerf::test
