#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "nerf/config/config.h"
#include "nerf/pipeline/events.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// A capture with everything that is known before a model of it is made: poses, splits, frame, and
// what its evidence calls for.
struct PreparedScene {
  PosedImages posed;  // in the units and the frame of the input
  SceneNormalization normalized_from_world;
  Inspection inspection;  // empty where nobody asked for one
  double inspection_seconds = 0;

  // Known exposures of the photographs that are trained on, log2 of light; empty: unknown.
  std::vector<double> StopsOf(const std::vector<View>& train) const;
};

// Poses of the input: read where it brings them, found by COLMAP in `folder`/colmap where it is a
// folder of photographs; then splits and frame.
//   threads  for COLMAP; 0: all cores
// Throws InputError.
PreparedScene PrepareScene(const std::filesystem::path& input, const std::filesystem::path& folder,
                           const DataOptions& options, int threads,
                           const PipelineListener& listener);

// Collects the evidence of effects; where it bounds the scene, changes the frame.
//   requested  effects that the user decides, as in `config`
void InspectScene(const Config& config, const std::set<std::string>& requested,
                  PreparedScene& scene, const PipelineListener& listener);

// The photographs, with the sparse points that a run keeps where depth supervision needs them;
// photographs that cannot be read are reported and left out.
//   run  its folder
Dataset LoadPhotographs(const PosedImages& posed, const Config& config,
                        const SceneNormalization& normalized_from_world,
                        const std::filesystem::path& run, const PipelineListener& listener);

// Keeps the sparse points in the run's folder where depth supervision needs them. Throws InputError
// where there are none.
void KeepSparsePoints(const PosedImages& posed, const Config& config,
                      const std::filesystem::path& run);

// Gives the photographs the points that the run keeps.
void AddKeptPoints(const PosedImages& posed, const SceneNormalization& normalized_from_world,
                   const std::filesystem::path& run, Dataset& data);

// Reports what will be read and held.
void ReportDataPlan(const PosedImages& posed, const DataOptions& options, int threads,
                    const PipelineListener& listener);

// Reports photographs that the poses name and that are not there.
void ReportMissing(const PosedImages& posed, const PipelineListener& listener);

}  // namespace nerf
