#include "nerf/splats/gaussian_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

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
// Learning rates are those of a fit of so many iterations, and for others times (this / their
// number)^power.
constexpr double kMostPixelsKept = 4e7;  // of all photographs, 25 bytes each
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

GaussianFit::GaussianFit(const std::vector<View>& views, bool has_alpha, GaussianCloud initial,
                         const SplatOptions& options, double near, std::uint64_t seed)
    : options_(options),
      has_alpha_(has_alpha),
      seed_(seed),
      views_(views),
      near_(near),
      cloud_(Reordered(initial, SpatialOrder(initial))),
      first_moment_(torch::zeros_like(cloud_.parameters)),
      second_moment_(torch::zeros_like(cloud_.parameters)),
      need_(static_cast<std::size_t>(cloud_.parameters.size(0)) * kGaussiansInBlock, 0.0f) {
  double pixels = 0;
  for (const View& view : views) pixels += static_cast<double>(PixelCount(view.camera));
  if (pixels <= kMostPixelsKept) {
    for (const View& view : views) {
      whole_.push_back(PictureOf(view, false));
      if (options_.half_resolution > 0) half_.push_back(PictureOf(view, true));
    }
  }
  turn_.resize(views.size());
  std::iota(turn_.begin(), turn_.end(), 0u);
}

GaussianFit::Picture GaussianFit::PictureOf(const View& view, bool is_half) const {
  is_half = is_half && std::min(view.camera.width, view.camera.height) > 1;
  const TargetPicture target = TargetOf(view);
  const Camera camera = is_half ? Downscaled(view.camera, 2) : view.camera;
  return {is_half ? Halved(target) : target,
          MakeGaussianCamera(camera, view.normalized_from_camera, near_)};
}

// Each photograph once in a random order, then again in another.
const GaussianFit::Picture& GaussianFit::NextPicture(double progress) {
  const auto count = static_cast<std::int64_t>(turn_.size());
  if (step_ % count == 0) {
    const auto round = static_cast<std::uint64_t>(step_ / count);
    std::ranges::sort(turn_, {}, [&](std::uint32_t i) {
      return RandomBits(seed_, kTurnStream, round * turn_.size() + i);
    });
  }
  const std::uint32_t photograph = turn_[step_ % count];
  const bool is_half = progress < options_.half_resolution;
  if (!whole_.empty()) return is_half ? half_[photograph] : whole_[photograph];
  picture_ = PictureOf(views_[photograph], is_half);
  return picture_;
}

double GaussianFit::Step(const FitProgress& progress) {
  const Picture& picture = NextPicture(progress.fraction);
  std::array<float, 3> background{};
  if (has_alpha_) {
    for (int c = 0; c < 3; ++c) {
      background[c] =
          RandomFloat(seed_, kBackgroundStream, static_cast<std::uint64_t>(3 * step_ + c));
    }
  }
  GaussianPicture& drawn = renderer_.Draw(picture.camera, cloud_.Parameters());
  const double loss =
      loss_.Evaluate(drawn, picture.target, background, options_.structural, gradient_);
  ++step_;
  const std::vector<RowGroup> groups = RowGroups(progress);
  correction_ = kernels::BiasCorrection(groups.front().adam, step_);
  renderer_.Backward(
      picture.camera, cloud_.Parameters(), gradient_, false,
      [&](std::int64_t block, std::span<float> gradients, std::span<const float> on_screen) {
        UpdateBlock(block, gradients, on_screen, groups);
      });
  if (step_ % options_.split_every == 0 && progress.fraction < options_.split_until) Split();
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
  if (cloud_.order > 0) {
    groups.push_back(group(kernels::kColorRow + 3,
                           kernels::GaussianRows(cloud_.order) - kernels::kColorRow - 3,
                           options_.harmonics_rate * decay));
  }
  return groups;
}

void GaussianFit::UpdateBlock(std::int64_t block, std::span<float> gradients,
                              std::span<const float> on_screen, std::span<const RowGroup> groups) {
  const std::size_t size = gradients.size();
  const std::size_t begin = static_cast<std::size_t>(block) * size;
  float* const parameters = cloud_.parameters.data_ptr<float>() + begin;
  float* const first = first_moment_.data_ptr<float>() + begin;
  float* const second = second_moment_.data_ptr<float>() + begin;
  for (int l = 0; l < kGaussiansInBlock; ++l) {
    need_[block * kGaussiansInBlock + l] += on_screen[l];
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
  double sum = 0;
  for (std::int64_t i = 0; i < cloud_.count; ++i) {
    const bool is_visible = cloud_.At(i, kernels::kOpacityRow) >= least;
    if (!is_visible) invisible.push_back(i);
    sum += is_visible ? static_cast<double>(need_[i]) : 0.0;
    total.push_back(sum);
  }
  const auto round = static_cast<std::uint64_t>(step_);
  std::ranges::sort(invisible, {}, [&](std::int64_t i) {
    return RandomBits(seed_ ^ round, kSplitStream, static_cast<std::uint64_t>(i));
  });
  const auto most =
      static_cast<std::size_t>(options_.split_share * static_cast<double>(cloud_.count));
  if (invisible.size() > most) invisible.resize(most);
  if (sum > 0) {
    for (const std::int64_t to : invisible) {
      const double drawn = sum * static_cast<double>(RandomFloat(seed_ ^ round, kSplitStream + 1,
                                                                 static_cast<std::uint64_t>(to)));
      const auto from = std::ranges::upper_bound(total, drawn) - total.begin();
      if (from < cloud_.count) SplitInto(from, to);
    }
  }
  std::ranges::fill(need_, 0.0f);
}

// Both are smaller than the one before, and apart by a random vector of its distribution.
void GaussianFit::SplitInto(std::int64_t from, std::int64_t to) {
  const auto quaternion = [&](int k) { return cloud_.At(from, kernels::kRotationRow + k); };
  const Eigen::Matrix3f axes =
      Eigen::Quaternionf(quaternion(0), quaternion(1), quaternion(2), quaternion(3))
          .normalized()
          .toRotationMatrix();
  Eigen::Vector3f along;
  for (int k = 0; k < 3; ++k) {
    along[k] = RandomNormal(seed_ ^ static_cast<std::uint64_t>(step_), kSplitStream + 2,
                            static_cast<std::uint64_t>(3 * to + k)) *
               std::exp(cloud_.At(from, kernels::kLogScaleRow + k));
  }
  const Eigen::Vector3f offset = kSplitDistance * (axes * along);
  float* const first = first_moment_.data_ptr<float>();
  float* const second = second_moment_.data_ptr<float>();
  for (int row = 0; row < kernels::GaussianRows(cloud_.order); ++row) {
    float value = cloud_.At(from, row);
    if (row >= kernels::kLogScaleRow && row < kernels::kRotationRow) value += std::log(kSplitScale);
    cloud_.At(from, row) = value;
    cloud_.At(to, row) = value;
    first[cloud_.Offset(from, row)] = first[cloud_.Offset(to, row)] = 0;
    second[cloud_.Offset(to, row)] = second[cloud_.Offset(from, row)];
  }
  for (int k = 0; k < 3; ++k) {
    cloud_.At(from, kernels::kMeanRow + k) -= offset[k];
    cloud_.At(to, kernels::kMeanRow + k) += offset[k];
  }
}

}  // namespace nerf
