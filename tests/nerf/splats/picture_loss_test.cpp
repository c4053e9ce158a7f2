#include "nerf/splats/picture_loss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "nerf/kernels/picture_loss.h"
#include "nerf/kernels/simd_level.h"

namespace nerf {
namespace {

constexpr int kColumns = 27, kRows = 22;
constexpr double kStructural = 0.3;
const std::array<float, 3> kBackground = {0.2f, 0.6f, 0.9f};

// [channel][y][x]
using Values = std::vector<double>;
std::size_t Index(int channel, int y, int x) {
  return (static_cast<std::size_t>(channel) * kRows + y) * kColumns + x;
}

// The loss by its definition: for each pixel the moments of its window, which are 0 beyond the
// border.
double LossOf(const Values& x, const Values& y, const std::vector<double>& weight) {
  double taps[11], total = 0;
  for (int k = -5; k <= 5; ++k) total += taps[k + 5] = std::exp(-k * k / 4.5);
  for (double& tap : taps) tap /= total;
  double loss = 0, weights = 0;
  for (int c = 0; c < 3; ++c) {
    for (int v = 0; v < kRows; ++v) {
      for (int u = 0; u < kColumns; ++u) {
        double mean_x = 0, mean_y = 0, xx = 0, yy = 0, xy = 0;
        for (int dv = -5; dv <= 5; ++dv) {
          for (int du = -5; du <= 5; ++du) {
            if (v + dv < 0 || v + dv >= kRows || u + du < 0 || u + du >= kColumns) continue;
            const double w = taps[dv + 5] * taps[du + 5];
            const double a = x[Index(c, v + dv, u + du)], b = y[Index(c, v + dv, u + du)];
            mean_x += w * a;
            mean_y += w * b;
            xx += w * a * a;
            yy += w * b * b;
            xy += w * a * b;
          }
        }
        const double ssim = (2 * mean_x * mean_y + 1e-4) * (2 * (xy - mean_x * mean_y) + 9e-4) /
                            ((mean_x * mean_x + mean_y * mean_y + 1e-4) *
                             (xx - mean_x * mean_x + yy - mean_y * mean_y + 9e-4));
        const double difference = x[Index(c, v, u)] - y[Index(c, v, u)];
        const double w = weight[static_cast<std::size_t>(v) * kColumns + u];
        loss += w * ((1 - kStructural) * std::sqrt(difference * difference + 9e-4) +
                     kStructural * (1 - ssim));
        weights += w;
      }
    }
  }
  return loss / weights;
}

// A picture with transparent parts, and a photograph like it, of which some pixels do not count.
struct Pictures {
  Pictures() {
    drawn.Resize(kColumns, kRows);
    std::ranges::fill(drawn.values, 7.0f);  // beyond the border: of no meaning
    target.Resize(kColumns, kRows);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> even(0, 1);
    for (int y = 0; y < kRows; ++y) {
      for (int x = 0; x < kColumns; ++x) {
        const float T = even(random);
        drawn.Plane(GaussianPicture::kTransmittance)[y * drawn.stride + x] = T;
        for (int c = 0; c < 3; ++c) {
          const float value = 0.5f + 0.4f * std::sin(0.3f * static_cast<float>(x + 2 * y + c));
          drawn.Plane(c)[y * drawn.stride + x] = (1 - T) * value;
          target.Row(c, y)[x] = value + 0.2f * (even(random) - 0.5f);
        }
        target.Row(TargetPicture::kOpacity, y)[x] = (x + y) % 5 == 0 ? 0.0f : 1.0f;
        target.Row(TargetPicture::kWeight, y)[x] = (x * y) % 7 == 3 ? 0.0f : 1.0f;
        weight.push_back(target.Row(TargetPicture::kWeight, y)[x]);
      }
    }
  }
  // Of `drawn`, before Evaluate changes it.
  Values Shown() const {
    Values shown;
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < kRows; ++y) {
        for (int x = 0; x < kColumns; ++x) {
          const auto at = [&](int plane) -> double {
            return drawn.Plane(plane)[y * drawn.stride + x];
          };
          shown.push_back(at(c) + at(GaussianPicture::kTransmittance) * kBackground[c]);
        }
      }
    }
    return shown;
  }
  Values Truth() const {
    Values truth;
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < kRows; ++y) {
        for (int x = 0; x < kColumns; ++x) {
          const double opacity = target.Row(TargetPicture::kOpacity, y)[x];
          const double known = opacity * target.Row(c, y)[x] + (1 - opacity) * kBackground[c];
          // What does not count is as it is drawn.
          truth.push_back(target.Row(TargetPicture::kWeight, y)[x] > 0 ? known
                                                                       : Shown()[Index(c, y, x)]);
        }
      }
    }
    return truth;
  }

  GaussianPicture drawn;
  TargetPicture target;
  std::vector<double> weight;
};

TEST(PictureLoss, IsThatOfTheDefinitionWithItsGradient) {
  const Pictures original;
  Values shown = original.Shown();
  const Values truth = original.Truth();
  const double loss = LossOf(shown, truth, original.weight);
  std::vector<double> differences;
  for (double& value : shown) {
    const double before = value;
    value = before + 1e-6;
    const double above = LossOf(shown, truth, original.weight);
    value = before - 1e-6;
    differences.push_back((above - LossOf(shown, truth, original.weight)) / 2e-6);
    value = before;
  }
  double weights = 0;
  for (const double w : original.weight) weights += 3 * w;
  for (const kernels::SimdLevel& level : kernels::SimdLevels()) {
    SCOPED_TRACE(level.name);
    const kernels::WithSimdLevel use(level);
    Pictures pictures;
    PictureLoss picture_loss;
    GaussianPicture gradient;
    EXPECT_NEAR(
        picture_loss.Evaluate(pictures.drawn, pictures.target, kBackground, kStructural, gradient),
        loss, 1e-5 * loss);
    for (int y = 0; y < kRows; ++y) {
      for (int x = 0; x < kColumns; ++x) {
        double by_T = 0;
        for (int c = 0; c < 3; ++c) {
          const double of_pixel = gradient.Plane(c)[y * gradient.stride + x];
          const bool counts = original.target.Row(TargetPicture::kWeight, y)[x] > 0;
          EXPECT_NEAR(of_pixel, counts ? weights * differences[Index(c, y, x)] : 0.0, 2e-4);
          by_T += kBackground[c] * of_pixel;
        }
        EXPECT_NEAR(gradient.Plane(GaussianPicture::kTransmittance)[y * gradient.stride + x], by_T,
                    1e-5);
      }
      for (int x = kColumns; x < gradient.stride; ++x) {
        EXPECT_EQ(gradient.Plane(0)[y * gradient.stride + x], 0);
      }
    }
  }
}

TEST(PictureLoss, HalvedIsTheMeanOfWhatCounts) {
  TargetPicture picture;
  picture.Resize(5, 2);
  for (int x = 0; x < 5; ++x) {
    for (int y = 0; y < 2; ++y) {
      picture.Row(0, y)[x] = static_cast<float>(10 * y + x);
      picture.Row(TargetPicture::kWeight, y)[x] = x == 1 && y == 1 ? 0.0f : 1.0f;
    }
  }
  const TargetPicture half = Halved(picture);
  EXPECT_EQ(half.width, 2);
  EXPECT_EQ(half.height, 1);
  EXPECT_FLOAT_EQ(half.Row(0, 0)[0], 11.0f / 3);
  EXPECT_FLOAT_EQ(half.Row(TargetPicture::kWeight, 0)[0], 0.75f);
  EXPECT_FLOAT_EQ(half.Row(0, 0)[1], 7.5f);
}

}  // namespace
}  // namespace nerf
