#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <type_traits>
#include <variant>

#include "nerf/model/checkpoint.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/representation_training.h"
#include "tests/support/small_capture.h"
#include "tests/support/tiny_training.h"

// Trainings of a field and Gaussians that take a second.
namespace nerf::test {

namespace fs = std::filesystem;

inline constexpr int kSteps = 120;

// A capture of which the last photographs validate.
inline SmallCapture CaptureWithValidation() {
  SmallCapture small = MakeSmallCapture(16, 48, 36);
  for (int i = 0; i < 2; ++i) {
    small.data.validation.push_back(small.data.train.back());
    small.data.train.pop_back();
  }
  small.scene = FactsOf(small.data, small.scene.normalized_from_world);
  return small;
}

inline Config ConfigOf(Representation representation) {
  Config config = SmallConfig();
  config.train.representation = representation;
  config.train.steps = kSteps;
  config.train.samples_per_batch = 8192;
  config.splats.count = 600;
  config.splats.steps = 80;
  config.train.checkpoint_every = 30;
  return config;
}

inline RepresentationsTrained Train(const SmallCapture& small, const Config& config,
                                    const fs::path& run, const std::atomic<bool>& stop = never_stop,
                                    const PipelineListener& listener = IgnoreEvents) {
  Trainer trainer(config, small.scene, small.data, run);
  return TrainRepresentations(trainer, small.data, run, stop, listener);
}

inline RepresentationsTrained Resume(const SmallCapture& small, const fs::path& run) {
  Trainer trainer(ReadRunCheckpoint(run), small.data, run);
  return TrainRepresentations(trainer, small.data, run, never_stop, IgnoreEvents);
}

inline void ExpectSameTensors(const fs::path& a, const fs::path& b) {
  const Checkpoint first = ReadCheckpoint(a), second = ReadCheckpoint(b);
  ASSERT_EQ(first.tensors.size(), second.tensors.size());
  for (const auto& [name, tensor] : first.tensors) {
    ASSERT_TRUE(second.tensors.contains(name)) << name;
    EXPECT_TRUE(torch::equal(tensor, second.tensors.at(name))) << name;
  }
}

// Stops a training at an iteration of the Gaussians, or of the field.
template <class Event>
void TrainUntil(std::int64_t step, const SmallCapture& small, const Config& config,
                const fs::path& run) {
  std::atomic<bool> stop = false;
  const auto listener = [&](const PipelineEvent& event) {
    const Event* taken = nullptr;
    if constexpr (std::is_same_v<Event, StepTaken>) {
      const auto* of_field = std::get_if<TrainerEvent>(&event);
      if (of_field) taken = std::get_if<Event>(of_field);
    } else {
      taken = std::get_if<Event>(&event);
    }
    if (taken && taken->step == step) stop = true;
  };
  EXPECT_FALSE(Train(small, config, run, stop, listener).finished);
}

}  // namespace nerf::test
