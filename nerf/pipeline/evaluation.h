#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nerf/model/snapshot.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

struct EvaluationOptions {
  double quality = 1;  // of rendering, see RenderQuality::Of
  // Compare each rendering at its photograph's own exposure, fitted: always done for models that
  // simulate exposures.
  bool fit_exposure = false;
  std::optional<int> downscale;  // of the photographs; the training's where it is not set
};

// A rendered view against its photograph.
struct ViewScore {
  std::string name;
  double psnr = 0, ssim = 0;  // PSNR in dB, over the pixels that no mask ignores
  double seconds = 0;         // of rendering
};

// What the views took, all together.
struct RenderCost {
  std::int64_t views = 0, pixels = 0, samples = 0;
  StageSeconds seconds;
  double reading = 0;  // seconds, of photographs

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

  ViewScore Mean() const;  // of one score at least
};

// What a listener sees of each view; the images live until it returns.
struct EvaluatedView {
  const PosedImage* image = nullptr;
  const Image* truth = nullptr;      // on white where it has alpha
  const Image* rendering = nullptr;  // at the photograph's exposure where that is fitted; pixels
                                     // that a mask ignores are the truth's
  const ViewScore* score = nullptr;
};

// The images of a split.
std::vector<const PosedImage*> ImagesOf(const PosedImages& posed, Split split);

// Renders views of photographs and compares them, as pictures would be saved: the one loop of
// `nerf eval` and `nerf study`.
//   posed   as OpenRun or the training have it
//   images  of `posed`
// Throws InputError where quality is not in [0, 1].
Evaluation Evaluate(const ModelSnapshot& model, const PosedImages& posed,
                    const std::vector<const PosedImage*>& images, const EvaluationOptions& options,
                    const std::function<void(const EvaluatedView&)>& listener = {});

}  // namespace nerf
