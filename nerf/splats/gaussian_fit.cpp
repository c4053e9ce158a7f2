#include "nerf/splats/gaussian_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "nerf/base/parallel.h"
#include "nerf/base/random.h"
#include "nerf/kernels/adam.h"
#include "nerf/scene/camera.h"
#include "nerf/splats/gaussian_camera.h"
#include "nerf/splats/target_pictures.h"

namespace nerf {
namespace {

using kernels::kGaussiansInBlock;

constexpr std::uint64_t kTurnStream = 0x67617573735f5f32ull;
constexpr std::uint64_t kBackgroundStream = 0x67617573735f5f34ull;
constexpr double kMostPixelsKept = 1e8;  // of all photographs, 6 bytes each
// Learning rates are those of a fit of so many iterations, and for others times (this / their
// number)^power.
constexpr double kRatedSteps = 2000, kRatePower = 0.5;

// Means of a block beyond the unit ball move in proportion to their distance: their rate is for
// what is within it, and farther away the same step is less in every picture.
class FarMeans {
 public:
  // Sets the means to 0: a step from there is not rounded to the digits of a far mean.
  explicit FarMeans(std::span<float> block) {
    std::copy_n(block.begin(), before_.size(), before_.begin());
    std::fill_n(block.begin(), before_.size(), 0.0f);
    for (int l = 0; l < kGaussiansInBlock; ++l) {
      const Eigen::Map<const Eigen::Vector3f, 0, Eigen::InnerStride<kGaussiansInBlock>> mean(
          &before_[l]);
      stride_[l] = std::max(1.0f, mean.norm());
    }
  }
  // After the step.
  void Stride(std::span<float> block) const {
    for (std::size_t k = 0; k < before_.size(); ++k) {
      block[k] = before_[k] + stride_[k % kGaussiansInBlock] * block[k];
    }
  }

 private:
  static_assert(kernels::kMeanRow == 0);
  std::array<float, 3 * kGaussiansInBlock> before_{};
  std::array<float, kGaussiansInBlock> stride_{};
};

}  // namespace

int HalvingsAt(const SplatOptions& options, double fraction) {
  if (fraction < options.quarter_resolution) return 2;
  return fraction < options.half_resolution ? 1 : 0;
}

GaussianFit::GaussianFit(std::vector<TargetView> views, bool has_alpha, GaussianFitState begin,
                         const SplatOptions& options, double near, std::uint64_t seed)
    : options_(options),
      has_alpha_(has_alpha),
      seed_(seed),
      views_(std::move(views)),
      near_(near),
      state_(std::move(begin)) {
  double pixels = 0;
  int first_kept = 1;  // in full a picture is made as fast as it is read
  for (const TargetView& view : views_) {
    pixels += static_cast<double>(PixelCount(view.camera));
    if (view.halvings > 0) first_kept = 0;  // but not where it is of a reduced photograph
  }
  if (pixels <= kMostPixelsKept) {
    for (int halvings = first_kept; halvings < kResolutions; ++halvings) {
      if (halvings > HalvingsAt(options_, 0)) break;
      pictures_[halvings].resize(views_.size());
      ParallelForEach(static_cast<std::int64_t>(views_.size()), [&](std::int64_t i) {
        MakePicture(views_[i], halvings, pictures_[halvings][i]);
      });
    }
  }
  turn_.resize(views_.size());
  std::iota(turn_.begin(), turn_.end(), 0u);
}

void GaussianFit::MakePicture(const TargetView& view, int halvings, Picture& picture) const {
  while (halvings > 0 && std::min(view.camera.width, view.camera.height) >> halvings < 1) {
    --halvings;
  }
  const TargetView reduced = Reduced(view, halvings);
  MakeTarget(reduced, picture.target);
  picture.camera = MakeGaussianCamera(reduced.camera, view.normalized_from_camera, near_);
}

// Each photograph once in a random order, then again in another.
const GaussianFit::Picture& GaussianFit::NextPicture(double progress) {
  const auto count = static_cast<std::int64_t>(turn_.size());
  if (const std::int64_t round = state_.step / count; round != round_) {
    round_ = round;
    std::ranges::sort(turn_, {}, [&](std::uint32_t i) {
      return RandomBits(seed_, kTurnStream, static_cast<std::uint64_t>(round) * turn_.size() + i);
    });
  }
  const std::uint32_t photograph = turn_[state_.step % count];
  const int halvings = HalvingsAt(options_, progress);
  if (!pictures_[halvings].empty()) return pictures_[halvings][photograph];
  MakePicture(views_[photograph], halvings, picture_);
  return picture_;
}

double GaussianFit::Step(const FitProgress& progress) {
  const Picture& picture = NextPicture(progress.fraction);
  std::array<float, 3> background{};
  if (has_alpha_) {
    for (int c = 0; c < 3; ++c) {
      background[c] =
          RandomFloat(seed_, kBackgroundStream, static_cast<std::uint64_t>(3 * state_.step + c));
    }
  }
  GaussianPicture& drawn = renderer_.Draw(picture.camera, state_.cloud.Parameters());
  const double loss =
      loss_.Evaluate(drawn, picture.target, background, options_.structural, gradient_);
  ++state_.step;
  const std::vector<RowGroup> groups = RowGroups(progress);
  correction_ = kernels::BiasCorrection(groups.front().adam, state_.step);
  renderer_.Backward(
      picture.camera, state_.cloud.Parameters(), gradient_, false,
      [&](std::int64_t block, std::span<float> gradients, std::span<const float> on_screen) {
        UpdateBlock(block, gradients, on_screen, groups);
      });
  if (state_.step % options_.split_every == 0 && progress.fraction < options_.split_until) {
    SplitWhereNeeded(state_, options_, seed_);
  }
  return is_finite_ ? loss : std::numeric_limits<double>::quiet_NaN();
}

std::vector<GaussianFit::RowGroup> GaussianFit::RowGroups(const FitProgress& progress) const {
  // Long fits end better with small steps.
  const double of_length = std::pow(kRatedSteps / progress.steps, kRatePower);
  const double decay = of_length * std::pow(options_.last_rate, progress.fraction);
  const auto group = [](int first, int count, double rate) {
    kernels::AdamCoefficients adam;
    adam.beta2 = 0.999f;
    adam.learning_rate = static_cast<float>(rate);
    return RowGroup{first, count, adam};
  };
  std::vector<RowGroup> groups = {
      group(kernels::kMeanRow, 3,
            options_.mean_rate * of_length * std::pow(options_.last_mean_rate, progress.fraction)),
      group(kernels::kLogScaleRow, 3, options_.scale_rate * decay),
      group(kernels::kRotationRow, 4, options_.rotation_rate * decay),
      group(kernels::kOpacityRow, 1, options_.opacity_rate * decay),
      group(kernels::kColorRow, 3, options_.color_rate * decay)};
  if (state_.cloud.order > 0) {
    groups.push_back(group(kernels::kColorRow + 3,
                           kernels::GaussianRows(state_.cloud.order) - kernels::kColorRow - 3,
                           options_.harmonics_rate * decay));
  }
  return groups;
}

void GaussianFit::UpdateBlock(std::int64_t block, std::span<float> gradients,
                              std::span<const float> on_screen, std::span<const RowGroup> groups) {
  const std::size_t size = gradients.size();
  const std::size_t begin = static_cast<std::size_t>(block) * size;
  float* const parameters = state_.cloud.parameters.data_ptr<float>() + begin;
  float* const first = state_.first_moment.data_ptr<float>() + begin;
  float* const second = state_.second_moment.data_ptr<float>() + begin;
  float* const need = state_.need.data_ptr<float>();
  for (int l = 0; l < kGaussiansInBlock; ++l) {
    need[block * kGaussiansInBlock + l] += on_screen[l];
    const std::size_t at = kernels::kOpacityRow * kGaussiansInBlock + l;
    const float o = 1 / (1 + std::exp(-parameters[at]));
    gradients[at] += static_cast<float>(options_.opacity_penalty) * o * (1 - o);
  }
  const FarMeans far({parameters, size});
  for (const RowGroup& group : groups) {
    const std::size_t at = static_cast<std::size_t>(group.first) * kGaussiansInBlock;
    const std::size_t values = static_cast<std::size_t>(group.count) * kGaussiansInBlock;
    const bool is_finite = kernels::AdamStep(group.adam, correction_, {parameters + at, values},
                                             gradients.subspan(at, values), {first + at, values},
                                             {second + at, values});
    if (!is_finite) is_finite_ = false;
  }
  far.Stride({parameters, size});
}

}  // namespace nerf
