#include "nerf/splats/picture_loss.h"

#include <algorithm>
#include <numeric>

#include "nerf/base/parallel.h"
#include "nerf/kernels/picture_loss.h"

namespace nerf {
namespace {

using kernels::kProducts;
using kernels::kWindowRadius;
using kernels::RowsAround;

constexpr std::int64_t kRowsAtOnce = 8;

// Rows of one plane in a buffer of planes.
class Rows {
 public:
  Rows(std::vector<float>& values, int plane, int height, int stride)
      : first_(&values[static_cast<std::size_t>(plane) * height * stride]),
        height_(height),
        stride_(stride) {}

  std::span<float> At(int y) const {
    return {first_ + static_cast<std::ptrdiff_t>(y) * stride_, static_cast<std::size_t>(stride_)};
  }
  RowsAround Around(int y) const {
    RowsAround around;
    for (int k = -kWindowRadius; k <= kWindowRadius; ++k) {
      if (y + k < 0 || y + k >= height_) continue;
      around.rows[kWindowRadius + k] = At(y + k).data();
    }
    return around;
  }

 private:
  float* first_;
  int height_, stride_;
};

// Calls use(channel, y) for all rows of three channels, in parallel.
template <class Use>
void ForEachRow(int height, const Use& use) {
  const std::int64_t groups = (height + kRowsAtOnce - 1) / kRowsAtOnce;
  ParallelForEach(3 * groups, [&](std::int64_t item) {
    const int channel = static_cast<int>(item / groups);
    const auto first = static_cast<int>(item % groups * kRowsAtOnce);
    const int last = std::min(height, first + static_cast<int>(kRowsAtOnce));
    for (int y = first; y < last; ++y) use(channel, y);
  });
}

// Fills the gradients of what PictureLossGradient does not write: rows below the picture, the
// transmittance, through which the background is seen, and the distance.
void GradientOfBackground(const std::array<float, 3>& background, int height,
                          GaussianPicture& gradient) {
  const std::size_t plane = static_cast<std::size_t>(gradient.rows) * gradient.stride;
  for (int channel = 0; channel < 3; ++channel) {
    std::fill(gradient.Row(channel, height), gradient.Plane(channel) + plane, 0.0f);
  }
  std::fill_n(gradient.Plane(GaussianPicture::kDistance), plane, 0.0f);
  float* const by_T = gradient.Plane(GaussianPicture::kTransmittance);
  ParallelFor(static_cast<std::int64_t>(plane), 4096, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t i = first; i < last; ++i) {
      by_T[i] = 0;
      for (int channel = 0; channel < 3; ++channel) {
        by_T[i] += background[channel] * gradient.Plane(channel)[i];
      }
    }
  });
}

}  // namespace

void TargetPicture::Resize(int new_width, int new_height) {
  width = new_width;
  height = new_height;
  stride = (width + GaussianPicture::kRowPadding - 1) / GaussianPicture::kRowPadding *
           GaussianPicture::kRowPadding;
  values.assign(static_cast<std::size_t>(kPlanes) * height * stride, 0.0f);
}

TargetPicture Halved(const TargetPicture& picture) {
  TargetPicture half;
  half.Resize(picture.width / 2, picture.height / 2);
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      float weight = 0, sums[4] = {};
      for (const int v : {2 * y, 2 * y + 1}) {
        for (const int u : {2 * x, 2 * x + 1}) {
          const float w = picture.Row(TargetPicture::kWeight, v)[u];
          weight += w;
          for (int plane = 0; plane < 4; ++plane) sums[plane] += w * picture.Row(plane, v)[u];
        }
      }
      if (weight == 0) continue;
      half.Row(TargetPicture::kWeight, y)[x] = weight / 4;
      for (int plane = 0; plane < 4; ++plane) half.Row(plane, y)[x] = sums[plane] / weight;
    }
  }
  return half;
}

void PictureLoss::Composite(GaussianPicture& drawn, const TargetPicture& target,
                            const std::array<float, 3>& background) {
  truth_.resize(static_cast<std::size_t>(3) * target.height * target.stride);
  ForEachRow(target.height, [&](int channel, int y) {
    const float* const T = drawn.Row(GaussianPicture::kTransmittance, y);
    float* const rgb = drawn.Row(channel, y);
    const std::span<float> truth = Rows(truth_, channel, target.height, target.stride).At(y);
    const float* const shown = target.Row(channel, y);
    const float* const opacity = target.Row(TargetPicture::kOpacity, y);
    const float* const weight = target.Row(TargetPicture::kWeight, y);
    for (int x = 0; x < target.width; ++x) {
      rgb[x] += T[x] * background[channel];
      const float truth_of = shown[x] * opacity[x] + (1 - opacity[x]) * background[channel];
      // What is not known is as it is drawn, so that windows that reach there do not learn from it.
      truth[x] = weight[x] > 0 ? truth_of : rgb[x];
    }
  });
}

// The first two passes. Returns the sum of weight SSIM of each row of each channel.
std::vector<double> PictureLoss::Compare(const GaussianPicture& drawn,
                                         const TargetPicture& target) {
  const int height = target.height, stride = target.stride;
  const auto width = static_cast<std::size_t>(target.width);
  products_.resize(static_cast<std::size_t>(3) * kProducts * height * stride);
  const auto product = [&](int channel, int k) {
    return Rows(products_, channel * kProducts + k, height, stride);
  };
  std::vector<double> similar(static_cast<std::size_t>(3) * height);
  ForEachRow(height, [&](int channel, int y) {
    kernels::ProductRows rows;
    for (int k = 0; k < kProducts; ++k) rows[k] = product(channel, k).At(y);
    kernels::BlurProducts({drawn.Row(channel, y), width},
                          Rows(truth_, channel, height, stride).At(y).first(width), rows);
  });
  ForEachRow(height, [&](int channel, int y) {
    std::array<RowsAround, kProducts> around;
    for (int k = 0; k < kProducts; ++k) around[k] = product(channel, k).Around(y);
    kernels::DerivativeRows rows;
    for (int k = 0; k < 3; ++k) rows[k] = Rows(derivatives_, channel * 3 + k, height, stride).At(y);
    similar[channel * height + y] = kernels::SimilarityDerivatives(
        around, {target.Row(TargetPicture::kWeight, y), static_cast<std::size_t>(stride)}, rows);
  });
  return similar;
}

double PictureLoss::Evaluate(GaussianPicture& drawn, const TargetPicture& target,
                             const std::array<float, 3>& background, double structural,
                             GaussianPicture& gradient) {
  const int height = target.height, stride = target.stride;
  const auto width = static_cast<std::size_t>(target.width);
  const auto padded = static_cast<std::size_t>(stride);
  Composite(drawn, target, background);
  gradient.Resize(drawn.width, drawn.height);
  derivatives_.assign(static_cast<std::size_t>(3) * 3 * height * stride, 0.0f);
  std::vector<double> similar;
  if (structural > 0) similar = Compare(drawn, target);
  std::vector<double> plain(static_cast<std::size_t>(3) * height);
  ForEachRow(height, [&](int channel, int y) {
    std::array<RowsAround, 3> around;
    for (int k = 0; k < 3; ++k) {
      around[k] = Rows(derivatives_, channel * 3 + k, height, stride).Around(y);
    }
    float* const row = gradient.Row(channel, y);
    plain[channel * height + y] = kernels::PictureLossGradient(
        around, {drawn.Row(channel, y), padded}, Rows(truth_, channel, height, stride).At(y),
        {target.Row(TargetPicture::kWeight, y), padded}, static_cast<float>(structural),
        {row, padded});
    std::fill(row + width, row + padded, 0.0f);
  });
  GradientOfBackground(background, height, gradient);
  double weights = 0;
  for (int y = 0; y < height; ++y) {
    const float* const row = target.Row(TargetPicture::kWeight, y);
    weights = std::accumulate(row, row + width, weights);
  }
  const double dissimilar = 3 * weights - std::accumulate(similar.begin(), similar.end(), 0.0);
  const double sum = std::accumulate(plain.begin(), plain.end(), 0.0) + structural * dissimilar;
  return weights > 0 ? sum / (3 * weights) : 0;
}

}  // namespace nerf
