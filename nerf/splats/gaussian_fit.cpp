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
constexpr std::uint64_t kSplitStream = 0x67617573735f5f33ull;
constexpr std::uint64_t kBackgroundStream = 0x67617573735f5f34ull;
constexpr double kMostPixelsKept = 1e8;  // of all photographs, 6 bytes each
// Learning rates are those of a fit of so many iterations, and for others times (this / their
// number)^power.
constexpr double kRatedSteps = 2000, kRatePower = 0.5;
// A Gaussian becomes two of this size, a standard deviation of its own apart.
constexpr float kSplitScale = 1 / 1.5f, kSplitDistance = 0.7f;

// A number of mean 0 and variance 1, by the sum of twelve even ones.
float RandomNormal(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  float sum = -6;
  for (std::uint64_t k = 0; k < 12; ++k) sum += RandomFloat(seed, stream, 12 * index + k);
  return sum;
}

}  // namespace

int HalvingsAt(const SplatOptions& options, double fraction) {
  if (fraction < options.quarter_resolution) return 2;
  return fraction < options.half_resolution ? 1 : 0;
}

GaussianFitState BeginFit(const GaussianCloud& initial) {
  GaussianCloud cloud = Reordered(initial, SpatialOrder(initial));
  const torch::Tensor& values = cloud.parameters;
  torch::Tensor need = torch::zeros({values.size(0) * kGaussiansInBlock});
  return {cloud, torch::zeros_like(values), torch::zeros_like(values), need, 0};
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
  if (state_.step % options_.split_every == 0 && progress.fraction < options_.split_until) Split();
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
  for (const RowGroup& group : groups) {
    const std::size_t at = static_cast<std::size_t>(group.first) * kGaussiansInBlock;
    const std::size_t values = static_cast<std::size_t>(group.count) * kGaussiansInBlock;
    const bool is_finite = kernels::AdamStep(group.adam, correction_, {parameters + at, values},
                                             gradients.subspan(at, values), {first + at, values},
                                             {second + at, values});
    if (!is_finite) is_finite_ = false;
  }
}

void GaussianFit::Split() {
  std::vector<std::int64_t> invisible;
  std::vector<double> total;  // running sum of the need of visible ones
  const auto least =
      static_cast<float>(std::log(options_.least_opacity / (1 - options_.least_opacity)));
  const float* const need = state_.need.data_ptr<float>();
  double sum = 0;
  for (std::int64_t i = 0; i < state_.cloud.count; ++i) {
    const bool is_visible = state_.cloud.At(i, kernels::kOpacityRow) >= least;
    if (!is_visible) invisible.push_back(i);
    sum += is_visible ? static_cast<double>(need[i]) : 0.0;
    total.push_back(sum);
  }
  const auto round = static_cast<std::uint64_t>(state_.step);
  std::ranges::sort(invisible, {}, [&](std::int64_t i) {
    return RandomBits(seed_ ^ round, kSplitStream, static_cast<std::uint64_t>(i));
  });
  const auto most =
      static_cast<std::size_t>(options_.split_share * static_cast<double>(state_.cloud.count));
  if (invisible.size() > most) invisible.resize(most);
  if (sum > 0) {
    for (const std::int64_t to : invisible) {
      const double drawn = sum * static_cast<double>(RandomFloat(seed_ ^ round, kSplitStream + 1,
                                                                 static_cast<std::uint64_t>(to)));
      const auto from = std::ranges::upper_bound(total, drawn) - total.begin();
      if (from < state_.cloud.count) SplitInto(from, to);
    }
  }
  state_.need.zero_();
}

// Both are smaller than the one before, and apart by a random vector of its distribution.
void GaussianFit::SplitInto(std::int64_t from, std::int64_t to) {
  const auto quaternion = [&](int k) { return state_.cloud.At(from, kernels::kRotationRow + k); };
  const Eigen::Matrix3f axes =
      Eigen::Quaternionf(quaternion(0), quaternion(1), quaternion(2), quaternion(3))
          .normalized()
          .toRotationMatrix();
  Eigen::Vector3f along;
  for (int k = 0; k < 3; ++k) {
    along[k] = RandomNormal(seed_ ^ static_cast<std::uint64_t>(state_.step), kSplitStream + 2,
                            static_cast<std::uint64_t>(3 * to + k)) *
               std::exp(state_.cloud.At(from, kernels::kLogScaleRow + k));
  }
  const Eigen::Vector3f offset = kSplitDistance * (axes * along);
  float* const first = state_.first_moment.data_ptr<float>();
  float* const second = state_.second_moment.data_ptr<float>();
  for (int row = 0; row < kernels::GaussianRows(state_.cloud.order); ++row) {
    float value = state_.cloud.At(from, row);
    if (row >= kernels::kLogScaleRow && row < kernels::kRotationRow) value += std::log(kSplitScale);
    state_.cloud.At(from, row) = value;
    state_.cloud.At(to, row) = value;
    first[state_.cloud.Offset(from, row)] = first[state_.cloud.Offset(to, row)] = 0;
    second[state_.cloud.Offset(to, row)] = second[state_.cloud.Offset(from, row)];
  }
  for (int k = 0; k < 3; ++k) {
    state_.cloud.At(from, kernels::kMeanRow + k) -= offset[k];
    state_.cloud.At(to, kernels::kMeanRow + k) += offset[k];
  }
}

}  // namespace nerf
