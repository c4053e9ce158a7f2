#pragma once

#include <filesystem>

#include "nerf/config/config.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// What training reads, with what a person is told about it on the way.

// Poses of the input: read where it brings them, found by COLMAP in the run's folder where it is a
// folder of photographs.
PosedImages FindPoses(const std::filesystem::path& input, const std::filesystem::path& run,
                      int threads);

// Names photographs that the poses tell of and that are not there.
void WarnOfMissing(const PosedImages& posed);

// A line on what will be read and held, before it is.
void PrintDataPlan(const PosedImages& posed, const DataOptions& options, int threads);

// Keeps the sparse points in the run's folder where distances are to be learned from them. Throws
// InputError where there are none.
void KeepSparsePoints(const PosedImages& found, const Config& config,
                      const std::filesystem::path& run);

// Gives the photographs the points that the run keeps.
void AddKeptPoints(const PosedImages& posed, const SceneNormalization& normalized_from_world,
                   const std::filesystem::path& run, Dataset& data);

// The photographs, with the points that the run keeps; those that cannot be read are named and left
// out.
Dataset LoadOrWarn(const PosedImages& posed, const Config& config,
                   const SceneNormalization& normalized_from_world,
                   const std::filesystem::path& run);

}  // namespace nerf
