#pragma once

#include <filesystem>
#include <memory>

#include "nerf/model/snapshot.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// What a run folder holds.
//   checkpoint.nerf  the model, and what training needs to go on
//   transforms.json  poses in the input's frame and units, with the splits
//   config.json      the configuration, every key
//   metrics.jsonl    a line each validation
//   colmap/          where poses were found from photographs
//   refined_transforms.json  the same after refinement, where poses are refined
//   sparse/          the input's sparse points, a COLMAP model, where distances are learned from
//   them
std::filesystem::path CheckpointPath(const std::filesystem::path& run);
std::filesystem::path PosesPath(const std::filesystem::path& run);
std::filesystem::path RefinedPosesPath(const std::filesystem::path& run);
std::filesystem::path ConfigPath(const std::filesystem::path& run);
std::filesystem::path MetricsPath(const std::filesystem::path& run);
std::filesystem::path ColmapPath(const std::filesystem::path& run);
std::filesystem::path SparsePath(const std::filesystem::path& run);

// A trained run, to be looked at.
struct OpenedRun {
  std::shared_ptr<const ModelSnapshot> model;
  PosedImages posed;  // as the training refined them, where it did
  double training_seconds = 0;
};

// The photographs need not be there any more: whoever compares with one will be told.
// Throws InputError naming what is missing or damaged.
OpenedRun OpenRun(const std::filesystem::path& run);

// The checkpoint of a run. Throws InputError when there is none.
Checkpoint ReadRunCheckpoint(const std::filesystem::path& run);

}  // namespace nerf
