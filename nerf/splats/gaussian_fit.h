#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "nerf/config/splat_options.h"
#include "nerf/kernels/adam.h"
#include "nerf/scene/view.h"
#include "nerf/splats/gaussian_fit_state.h"
#include "nerf/splats/picture_loss.h"
#include "nerf/splats/target_pictures.h"

namespace nerf {

// Where a fit stands.
struct FitProgress {
  double fraction = 0;  // 0 to 1: by iterations or by time
  double steps = 0;     // iterations of the whole fit; of a fit by time, about
};

// A fit begins at a quarter of the resolution, then half of it.
inline constexpr int kResolutions = 3;
// How often the resolution is halved at a position of the fit.
int HalvingsAt(const SplatOptions& options, double fraction);

// Fits Gaussians to photographs: Adam on the loss of one whole photograph after another, first at
// lower resolutions; Gaussians that became invisible are put where the picture asks for more:
// they split those of which the position has the largest gradients. With the same seed the result
// is the same bits, for any number of threads. Source: Kerbl et al. 2023, "3D Gaussian Splatting
// for Real-Time Radiance Field Rendering".
class GaussianFit {
 public:
  //   has_alpha  then the background is random, as in the field's training; else black
  GaussianFit(std::vector<TargetView> views, bool has_alpha, GaussianFitState begin,
              const SplatOptions& options, double near, std::uint64_t seed);

  // One iteration. Returns the loss; NaN if that, a gradient or a parameter is not finite.
  double Step(const FitProgress& progress);

  // Goes on with fewer: KeepMostVisible.
  void Keep(std::int64_t count) { KeepMostVisible(state_, count); }

  const GaussianCloud& Cloud() const { return state_.cloud; }
  const GaussianFitState& State() const { return state_; }
  std::int64_t Steps() const { return state_.step; }

 private:
  // A photograph at one resolution.
  struct Picture {
    TargetPicture target;
    kernels::GaussianCamera camera;
  };
  void MakePicture(const TargetView& view, int halvings, Picture& picture) const;
  const Picture& NextPicture(double progress);
  // Rows of parameters that share a learning rate.
  struct RowGroup {
    int first, count;
    kernels::AdamCoefficients adam;
  };
  std::vector<RowGroup> RowGroups(const FitProgress& progress) const;
  void UpdateBlock(std::int64_t block, std::span<float> gradients, std::span<const float> on_screen,
                   std::span<const RowGroup> groups);

  SplatOptions options_;
  bool has_alpha_;
  std::uint64_t seed_;
  std::vector<TargetView> views_;
  double near_;
  // By the number of halvings; empty where they are made for each step: in full, and where all of
  // them would need too much memory.
  std::array<std::vector<Picture>, kResolutions> pictures_;
  Picture picture_;                  // then that of this step
  std::vector<std::uint32_t> turn_;  // the order of the photographs
  std::int64_t round_ = -1;          // to which it belongs
  GaussianFitState state_;
  kernels::AdamBiasCorrection correction_;  // of this step
  GaussianRenderer renderer_;
  PictureLoss loss_;
  GaussianPicture gradient_;
  std::atomic<bool> is_finite_ = true;
};

}  // namespace nerf
