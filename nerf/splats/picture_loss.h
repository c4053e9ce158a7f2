#pragma once

#include <vector>

#include "nerf/splats/gaussian_renderer.h"

namespace nerf {

// A photograph as planes, padded like GaussianPicture: red, green, blue, opacity, and a weight that
// is 0 where nothing is to be learned, and beyond the border.
struct TargetPicture {
  static constexpr int kPlanes = 5;
  static constexpr int kOpacity = 3, kWeight = 4;

  int width = 0, height = 0, stride = 0;
  std::vector<float> values;  // [kPlanes][height][stride]

  void Resize(int new_width, int new_height);
  float* Row(int plane, int y) {
    return &values[(static_cast<std::size_t>(plane) * height + y) * stride];
  }
  const float* Row(int plane, int y) const {
    return &values[(static_cast<std::size_t>(plane) * height + y) * stride];
  }
};

// Half the resolution: the mean of four pixels each, weighted; of odd sides the last row or column
// is left out.
TargetPicture Halved(const TargetPicture& picture);

// The loss of kernels/picture_loss.h over a picture. Uses all threads.
class PictureLoss {
 public:
  // Replaces the colours of `drawn` by those on a background, and computes the gradients by what
  // GaussianRenderer::Draw wrote. Where the photograph is transparent, it shows the background,
  // too.
  //   structural  share of SSIM
  //   gradient    written
  //   returns     mean over the weighted pixels and channels
  double Evaluate(GaussianPicture& drawn, const TargetPicture& target,
                  const std::array<float, 3>& background, double structural,
                  GaussianPicture& gradient);

 private:
  void Composite(GaussianPicture& drawn, const TargetPicture& target,
                 const std::array<float, 3>& background);
  std::vector<double> Compare(const GaussianPicture& drawn, const TargetPicture& target);

  std::vector<float> truth_;        // [3][height][stride] on the background
  std::vector<float> products_;     // [3][kProducts][height][stride]
  std::vector<float> derivatives_;  // [3][3][height][stride]
};

}  // namespace nerf
