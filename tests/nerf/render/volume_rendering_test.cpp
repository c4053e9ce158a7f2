#include "nerf/render/volume_rendering.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "nerf/base/parallel.h"
#include "nerf/field/libtorch.h"
#include "tests/support/central_differences.h"

namespace nerf {
namespace {

struct Batch {
  torch::Tensor ray_begin = torch::tensor({0, 5, 5, 12}, torch::kLong);  // the middle ray is empty
  torch::Tensor sigma, radiance, dt, t, background;

  explicit Batch(torch::Dtype dtype = torch::kDouble) {
    torch::manual_seed(3);
    sigma = (3 * torch::rand({12}, dtype)).requires_grad_();
    radiance = torch::rand({12, 3}, dtype).requires_grad_();
    dt = 0.2 * torch::rand({12}, dtype) + 0.01;
    t = torch::cumsum(dt, 0);
    background = torch::rand({3, 3}, dtype).requires_grad_();
  }

  VolumeRendering Render() const {
    return RenderVolume(ray_begin, sigma, radiance, dt, t, background);
  }

  // A scalar that depends on every output.
  torch::Tensor Loss() const {
    const VolumeRendering out = Render();
    return out.rgb.square().sum() + 0.3 * out.opacity.square().sum() + 0.1 * out.depth.sum();
  }
};

TEST(RenderVolume, GradientsMatchCentralDifferences) {
  Batch batch;
  const auto loss = [&] { return batch.Loss(); };
  for (const torch::Tensor& x : {batch.sigma, batch.radiance, batch.background}) {
    test::ExpectGradientMatchesCentralDifferences(loss, x, 1e-5, 1e-8);
  }
}

TEST(RenderVolume, AnEmptyRayShowsItsBackground) {
  const Batch batch;
  const VolumeRendering out = batch.Render();
  EXPECT_TRUE(torch::equal(out.rgb[1], batch.background[1]));
  EXPECT_EQ(out.opacity[1].item<double>(), 0.0);
}

TEST(RenderVolume, ABatchWithoutRaysIsEmpty) {
  const auto none = [](at::IntArrayRef shape) { return torch::empty(shape); };
  const VolumeRendering out = RenderVolume(torch::zeros({1}, torch::kLong), none({0}), none({0, 3}),
                                           none({0}), none({0}), none({0, 3}));
  EXPECT_EQ(out.rgb.sizes(), at::IntArrayRef({0, 3}));
}

TEST(RenderVolume, TheNumberOfThreadsChangesNothing) {
  SetNumThreads(1);
  Batch one(torch::kFloat);
  one.Loss().backward();
  SetNumThreads(3);
  Batch three(torch::kFloat);
  three.Loss().backward();
  SetNumThreads(AvailableCores());
  EXPECT_TRUE(torch::equal(one.sigma.grad(), three.sigma.grad()));
  EXPECT_TRUE(torch::equal(one.radiance.grad(), three.radiance.grad()));
}

TEST(RenderVolume, SamplesOutOfOrderAreReportedWithTheirRay) {
  const double nan = std::nan("");
  const auto rejection = [](torch::Tensor Batch::*values, std::int64_t sample, double value) {
    Batch batch;  // rays of 5, 0 and 7 samples
    (batch.*values)[sample] = value;
    try {
      batch.Render();
    } catch (const c10::Error& error) {
      return std::string(error.msg());
    }
    return std::string("no error");
  };
  EXPECT_THAT(rejection(&Batch::dt, 6, -0.1), testing::HasSubstr("ray 2"));
  EXPECT_THAT(rejection(&Batch::dt, 4, nan), testing::HasSubstr("ray 0"));
  EXPECT_THAT(rejection(&Batch::t, 3, 0.0),
              testing::HasSubstr("ray 0: t decreases or is NaN at sample 3"));
  EXPECT_THAT(rejection(&Batch::t, 5, nan), testing::HasSubstr("ray 2"));
  EXPECT_THAT(rejection(&Batch::t, 0, -5.0), testing::HasSubstr("no error"));
}

TEST(RenderVolume, RejectsShapesThatDoNotMatch) {
  Batch batch;
  batch.dt = batch.dt.slice(0, 0, 5);
  EXPECT_THROW(batch.Render(), c10::Error);
  Batch short_rays;
  short_rays.ray_begin = torch::tensor({0, 5, 5, 11}, torch::kLong);
  EXPECT_THROW(short_rays.Render(), c10::Error);
}

}  // namespace
}  // namespace nerf
