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

// A capture with everything that is known before a model is made: poses, splits, normalized frame,
// and verdicts on effects.
struct PreparedScene {
  PosedImages posed;              // in the units and the frame of the input
  bool from_photographs = false;  // poses were found for plain photographs or a film
  SceneNormalization normalized_from_world;
  Inspection inspection;  // empty without InspectScene
  double inspection_seconds = 0;

  // The measured exposures of the training photographs, log2 of light; empty: unknown.
  std::vector<double> StopsOf(const std::vector<View>& train) const;
};

// Reads the poses of the input, or finds them with COLMAP in `folder`/colmap for plain photographs;
// assigns splits and normalizes the scene.
// Throws InputError.
PreparedScene PrepareScene(const std::filesystem::path& input, const std::filesystem::path& folder,
                           const DataOptions& options, const PipelineListener& listener);

// How long finding sparse points may take: data.points_share of a time budget, else as long as the
// training.
double PointSeconds(const Config& config);

// Finds sparse points in `folder`/points for poses that were given without any (FindMissingPoints).
void AddMissingPoints(PreparedScene& scene, const std::filesystem::path& folder,
                      double most_seconds, const PipelineListener& listener);

// Inspects the capture. If the scene is bounded, changes the normalized frame.
//   requested  effects that the user has decided, as in `config`
void InspectScene(const Config& config, const std::set<std::string>& requested,
                  PreparedScene& scene, const PipelineListener& listener);

// Reads the photographs, with the run's saved sparse points if depth supervision is on.
// Photographs that cannot be read are reported and skipped.
//   run  folder
Dataset LoadPhotographs(const PosedImages& posed, const Config& config,
                        const SceneNormalization& normalized_from_world,
                        const std::filesystem::path& run, const PipelineListener& listener);

// Saves the sparse points in the run folder if depth supervision is on. Throws InputError if there
// are none.
void SaveSparsePoints(const PosedImages& posed, const Config& config,
                      const std::filesystem::path& run);

// Adds the run's saved sparse points to the photographs.
void AddSavedSparsePoints(const PosedImages& posed, const SceneNormalization& normalized_from_world,
                          const std::filesystem::path& run, Dataset& data);

// Reports which photographs will be read, and the memory they need.
void ReportDataPlan(const PosedImages& posed, const DataOptions& options, int threads,
                    const PipelineListener& listener);

// Reports photographs that have poses but are missing, and what else is odd about the source.
void ReportMissing(const PosedImages& posed, const PipelineListener& listener);

}  // namespace nerf
