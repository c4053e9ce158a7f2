#include "nerf/image/image_metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "nerf/base/input_error.h"
#include "nerf/image/srgb.h"
#include "nerf/reference/ssim_reference.h"

namespace nerf {
namespace {

Image Flat(int width, int height, float value) {
  Image image(width, height, 3);
  for (float& v : image.pixels) v = value;
  return image;
}

Image Noise(int width, int height, int seed) {
  std::mt19937 random(seed);
  Image image(width, height, 3);
  for (float& v : image.pixels) v = static_cast<float>(random() % 256) / 255.0f;
  return image;
}

// A smooth picture with some noise on it.
Image Smooth(int width, int height, float noise) {
  const Image grain = Noise(width, height, 3);
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        image.At(x, y)[c] =
            0.5f + 0.4f * std::sin(0.2f * x + 0.1f * y + c) + noise * (grain.At(x, y)[c] - 0.5f);
      }
    }
  }
  return image;
}

TEST(Psnr, IsMinusTenLogOfTheMeanSquare) {
  Image a = Flat(2, 1, 0.0f);
  Image b = a;
  b.pixels[0] = 51 / 255.0f;  // squared error 0.04 in one of six values
  EXPECT_NEAR(Psnr(a, b), -10 * std::log10(0.04 / 6), 1e-5);
  EXPECT_NEAR(Psnr(Flat(4, 4, 1), Flat(4, 4, 0)), 0, 1e-9);
}

TEST(Psnr, OfEqualImagesIsInfinite) {
  EXPECT_EQ(Psnr(Noise(5, 5, 1), Noise(5, 5, 1)), std::numeric_limits<double>::infinity());
}

TEST(Psnr, ComparesEightBitValues) {
  EXPECT_TRUE(std::isinf(Psnr(Flat(3, 3, 0.5001f), Flat(3, 3, 0.5f))));
  EXPECT_TRUE(std::isinf(Psnr(Flat(3, 3, 1.7f), Flat(3, 3, 1.0f))));
  EXPECT_TRUE(std::isinf(Psnr(Flat(3, 3, -0.2f), Flat(3, 3, 0.0f))));
  EXPECT_NEAR(Psnr(Flat(3, 3, 0.502f), Flat(3, 3, 0.498f)), 20 * std::log10(255), 1e-4);
}

TEST(Psnr, LinearImagesAreComparedInSrgb) {
  Image linear = Flat(2, 2, LinearFromSrgb(0.6f));
  linear.encoding = ColorEncoding::kLinear;
  EXPECT_TRUE(std::isinf(Psnr(linear, Flat(2, 2, 0.6f))));
}

TEST(Psnr, AlphaIsCompositedOnWhiteInSrgb) {
  Image image(1, 1, 4);
  image.pixels = {0.2f, 0.4f, 0.6f, 0.5f};
  Image expected(1, 1, 3);
  expected.pixels = {0.6f, 0.7f, 0.8f};
  EXPECT_TRUE(std::isinf(Psnr(image, expected)));
}

TEST(Ssim, AgreesWithTheDefinitionWindowByWindow) {
  const Image truth = Quantized(Smooth(29, 23, 0.0f));
  for (const float noise : {0.05f, 0.4f}) {
    const Image image = Quantized(Smooth(29, 23, noise));
    EXPECT_NEAR(Ssim(truth, image), reference::Ssim(truth, image), 1e-9);
  }
  EXPECT_NEAR(Ssim(Noise(15, 12, 1), Noise(15, 12, 2)),
              reference::Ssim(Noise(15, 12, 1), Noise(15, 12, 2)), 1e-9);
}

TEST(Ssim, OfEqualImagesIsOneAndFallsWithNoise) {
  const Image truth = Smooth(40, 30, 0);
  EXPECT_NEAR(Ssim(truth, truth), 1, 1e-12);
  EXPECT_LT(Ssim(truth, Smooth(40, 30, 0.3f)), Ssim(truth, Smooth(40, 30, 0.1f)));
  EXPECT_LT(Ssim(truth, Smooth(40, 30, 0.1f)), 0.999);
}

TEST(Ssim, OfConstantImagesDependsOnlyOnTheirMeans) {
  const double a = 51 / 255.0;
  const double b = 204 / 255.0;
  EXPECT_NEAR(Ssim(Flat(11, 11, 0.2f), Flat(11, 11, 0.8f)),
              (2 * a * b + 1e-4) / (a * a + b * b + 1e-4), 1e-6);
}

TEST(ImageMetrics, RefuseImagesThatDoNotMatch) {
  EXPECT_THROW(Psnr(Flat(3, 4, 0), Flat(4, 3, 0)), InputError);
  EXPECT_THROW(Psnr(Image(), Image()), InputError);
  EXPECT_THROW(Ssim(Flat(20, 20, 0), Flat(20, 21, 0)), InputError);
  EXPECT_THROW(Ssim(Flat(10, 20, 0), Flat(10, 20, 0)), InputError);
}

}  // namespace
}  // namespace nerf
