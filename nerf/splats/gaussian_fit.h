#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "nerf/config/splat_options.h"
#include "nerf/kernels/adam.h"
#include "nerf/scene/view.h"
#include "nerf/splats/gaussian_cloud.h"
#include "nerf/splats/picture_loss.h"

namespace nerf {

// Where a fit stands.
struct FitProgress {
  double fraction = 0;  // 0 to 1: by iterations or by time
  double steps = 0;     // iterations of the whole fit; of a fit by time, about
};

// Fits Gaussians to photographs: Adam on the loss of one whole photograph after another, first at
// half the resolution; Gaussians that became invisible are put where the picture asks for more:
// they split those of which the position has the largest gradients. With the same seed the result
// is the same bits, for any number of threads. Source: Kerbl et al. 2023, "3D Gaussian Splatting
// for Real-Time Radiance Field Rendering".
class GaussianFit {
 public:
  //   views      must outlive this
  //   has_alpha  then the background is random, as in the field's training; else black
  GaussianFit(const std::vector<View>& views, bool has_alpha, GaussianCloud initial,
              const SplatOptions& options, double near, std::uint64_t seed);

  // One iteration. Returns the loss; NaN if that, a gradient or a parameter is not finite.
  double Step(const FitProgress& progress);

  const GaussianCloud& Cloud() const { return cloud_; }
  std::int64_t Steps() const { return step_; }

 private:
  // A photograph at one resolution.
  struct Picture {
    TargetPicture target;
    kernels::GaussianCamera camera;
  };
  Picture PictureOf(const View& view, bool is_half) const;
  const Picture& NextPicture(double progress);
  // Rows of parameters that share a learning rate.
  struct RowGroup {
    int first, count;
    kernels::AdamCoefficients adam;
  };
  std::vector<RowGroup> RowGroups(const FitProgress& progress) const;
  void UpdateBlock(std::int64_t block, std::span<float> gradients, std::span<const float> on_screen,
                   std::span<const RowGroup> groups);
  void Split();
  void SplitInto(std::int64_t from, std::int64_t to);

  SplatOptions options_;
  bool has_alpha_;
  std::uint64_t seed_;
  const std::vector<View>& views_;
  double near_;
  std::vector<Picture> whole_, half_;  // empty where they would need too much memory
  Picture picture_;                    // then that of this step
  std::vector<std::uint32_t> turn_;    // the order of the photographs
  GaussianCloud cloud_;
  torch::Tensor first_moment_, second_moment_;  // of Adam, as the parameters
  kernels::AdamBiasCorrection correction_;      // of this step
  std::vector<float> need_;                     // gradient on the screen since the last split
  GaussianRenderer renderer_;
  PictureLoss loss_;
  GaussianPicture gradient_;
  std::int64_t step_ = 0;
  std::atomic<bool> is_finite_ = true;
};

}  // namespace nerf
