#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nerf/model/scene_model.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

struct EvaluationOptions {
  double quality = 1;  // of rendering, see RenderQuality::Of
  // Render each view at the exposure fitted to its photograph. Always done for models that simulate
  // exposures.
  bool fit_exposure = false;
  std::optional<int> downscale;  // of the photographs; nullopt: as in training
};

// The score of a rendered view against its photograph.
struct ViewScore {
  std::string name;
  double psnr = 0, ssim = 0;  // PSNR in dB, without pixels that a mask ignores
  double seconds = 0;         // rendering time
};

// The cost of all views together.
struct RenderCost {
  std::int64_t views = 0, pixels = 0, samples = 0;
  int width = 0, height = 0;  // of the largest view, pixels
  StageSeconds seconds;
  double reading = 0;  // seconds for reading photographs

  void Add(const RenderedView& view);
  double SamplesPerRay() const {
    return static_cast<double>(samples) / static_cast<double>(pixels);
  }
  double PerView(double seconds_of_all) const {
    return seconds_of_all / static_cast<double>(views);
  }
};

struct Evaluation {
  std::vector<ViewScore> scores;
  RenderCost cost;
  std::vector<std::string> unreadable;  // photographs that could not be read, with the reason
  bool exposure_fitted = false;

  ViewScore Mean() const;  // needs at least one score
};

// A view as reported to a listener; the images are valid during the call.
struct EvaluatedView {
  const PosedImage* image = nullptr;
  const Image* truth = nullptr;      // composited on white if it has alpha
  const Image* rendering = nullptr;  // at the fitted exposure, if it is fitted; pixels that a mask
                                     // ignores are those of the truth
  const ViewScore* score = nullptr;
};

// The images of a split.
std::vector<const PosedImage*> ImagesOf(const PosedImages& posed, Split split);

// Renders the views of photographs and scores them as they would be saved (8-bit sRGB). Used by
// `nerf eval` and `nerf study`.
//   posed   with refined poses, if the model has them (OpenRun, RefinedPoses)
//   images  point into `posed`
// Throws InputError if quality is not in [0, 1].
Evaluation Evaluate(const SceneModel& model, const PosedImages& posed,
                    const std::vector<const PosedImage*>& images, const EvaluationOptions& options,
                    const std::function<void(const EvaluatedView&)>& listener = {});

}  // namespace nerf
