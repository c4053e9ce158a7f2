#pragma once

#include <vector>

#include "nerf/image/image.h"
#include "nerf/model/snapshot.h"

namespace nerf {

// A rendering quality with its cost and its error in a view.
struct MeasuredQuality {
  double quality = 1;
  double seconds = 0;  // per frame
  double psnr = 0;     // dB, relative to the exact rendering; infinite if they are equal
};

// Measures the time of rendering qualities, and their error relative to exact rendering, on strips
// of a view, about an eighth of it.
class QualityProbe {
 public:
  // Renders the exact strips. `model` must outlive it.
  //   view  only camera and pose are used
  QualityProbe(const ModelSnapshot& model, const ViewRequest& view);

  // Throws InputError where quality is not in [0, 1].
  MeasuredQuality Measure(double quality) const;

  // The highest quality at which a frame takes at most `seconds`, by bisection; quality 0 if none
  // does.
  MeasuredQuality Choose(double seconds) const;

 private:
  Image Render(double quality, double& seconds) const;

  const ModelSnapshot& model_;
  std::vector<ViewRequest> strips_;
  double strips_per_frame_ = 1;
  Image exact_;
  double exact_seconds_ = 0;
};

}  // namespace nerf
