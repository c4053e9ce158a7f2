#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nerf/config/config.h"
#include "nerf/model/gaussian_model.h"
#include "nerf/model/snapshot.h"
#include "nerf/pipeline/events.h"
#include "nerf/scene/dataset.h"

namespace nerf {

// What Gaussians are fitted to: photographs with the cameras and exposures that a field has
// learned. Their configuration has no harmonics where the field simulates no view dependence.
struct GaussianScene {
  Config config;
  SceneFacts facts;
  std::vector<TargetView> train, validation;
};

// The options of a fit to photographs. Where no number of Gaussians is given (0), it grows with the
// photographs, and more where there is time for more; at most as many as memory holds. Low
// resolutions then take longer the more pixels photographs have.
//   seconds  of the fit; 0: it is by iterations, and has time
SplatOptions SplatOptionsFor(const SplatOptions& options, const Dataset& data, double seconds);

// Throws InputError for linear photographs, to which Gaussians are not fitted yet.
//   splats   options of the fit; other options are those of the field
//   data     must outlive the result
//   seconds  see SplatOptionsFor
GaussianScene GaussianSceneOf(const Model& field, const SplatOptions& splats, const Dataset& data,
                              double seconds);
// The same with the options of the field.
GaussianScene GaussianSceneOf(const Model& field, const Dataset& data, double seconds);

// Why there is too little memory for a fit; empty: there is enough.
std::string TooLittleMemory(const SplatOptions& options);

// Reports the effects of a configuration that only the training of the field simulates.
void WarnOfFieldsEffects(const Config& config, const PipelineListener& listener);

// Where a fit begins.
struct GaussianStart {
  GaussianFitState state;
  double near = 0;     // means nearer to a camera are not drawn, normalized units
  FitFacts made = {};  // so far, where it was interrupted
};

// Begins at the surfaces that a field renders (FindSurfacePoints), or where its views agree on none
// at the visual hull of photographs with alpha.
//   progress  called with the number of views done, of scene.train
//   returns   nullopt where it was stopped
// Throws InputError where its views agree on no surface, or where there is too little memory.
std::optional<GaussianStart> StartAtSurfaces(const SceneModel& field, const GaussianScene& scene,
                                             const std::atomic<bool>& stop,
                                             const std::function<void(std::size_t)>& progress);

}  // namespace nerf
