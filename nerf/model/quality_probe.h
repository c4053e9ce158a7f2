#pragma once

#include <vector>

#include "nerf/image/image.h"
#include "nerf/model/snapshot.h"

namespace nerf {

// A rendering quality, with what it costs and loses in a view.
struct MeasuredQuality {
  double quality = 1;
  double seconds = 0;  // a frame
  double psnr = 0;  // dB, against the exact picture of the same view; infinite where they are equal
};

// Measures on strips of a view, about an eighth of it, how long rendering qualities take and how
// far they are from the exact picture.
class QualityProbe {
 public:
  // `model` must outlive it. Renders the strips exactly.
  //   view  its camera and pose
  QualityProbe(const ModelSnapshot& model, const ViewRequest& view);

  // Throws InputError where quality is not in [0, 1].
  MeasuredQuality Measure(double quality) const;

  // The best quality at which a frame takes at most `seconds`, found by halving; the fast end where
  // none does.
  MeasuredQuality Choose(double seconds) const;

 private:
  Image Render(double quality, double& seconds) const;

  const ModelSnapshot& model_;
  std::vector<ViewRequest> strips_;
  double strips_in_a_frame_ = 1;
  Image exact_;
  double exact_seconds_ = 0;
};

}  // namespace nerf
