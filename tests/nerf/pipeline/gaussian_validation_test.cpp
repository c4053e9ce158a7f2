#include "nerf/pipeline/gaussian_validation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "nerf/model/run_folder.h"
#include "nerf/splats/initial_gaussians.h"
#include "tests/support/representation_training.h"

namespace nerf {
namespace {

using test::CaptureWithValidation;
using test::ConfigOf;

// The pixels of a view are looked up where they are drawn: photographs that Gaussians have drawn
// themselves are reached but for rounding.
TEST(GaussianValidation, FindsThePixelsOfAView) {
  test::SmallCapture small = CaptureWithValidation();
  small.scene.has_alpha = true;
  const Config config = ConfigOf(Representation::kSplats);
  std::vector<ColoredPoint> points;
  for (int i = 0; i < 60; ++i) {
    points.push_back({Eigen::Vector3d(i % 4 - 1.5, i / 4 % 4 - 1.5, i / 16 - 1.5) * 0.2,
                      Eigen::Vector3f(i % 3 / 2.0f, i % 5 / 4.0f, i % 7 / 6.0f)});
  }
  const GaussianCloud cloud = GaussiansAtPoints(points, 60, 0, 1);
  constexpr double kNear = 0.05;
  for (View& view : small.data.validation) {
    const GaussianModel model(config, small.scene, cloud, kNear, {});
    const RenderedView drawn = model.Render(
        {view.camera,
         small.scene.normalized_from_world.WorldFromCamera(view.normalized_from_camera)});
    for (std::size_t p = 0; p < drawn.opacity.pixels.size(); ++p) {
      const float alpha = drawn.opacity.pixels[p];
      for (int c = 0; c < 3; ++c) {
        const float premultiplied = drawn.rgb.pixels[3 * p + c] - (1 - alpha);  // without white
        view.rgba[4 * p + c] = Eigen::half(alpha > 1e-4f ? premultiplied / alpha : 0.0f);
      }
      view.rgba[4 * p + 3] = Eigen::half(alpha);
    }
  }
  const Model field = MakeModel(config, small.scene);
  const GaussianScene scene = GaussianSceneOf(field, small.data, 0);
  const GaussianValidation validation(scene, small.data);
  EXPECT_GT(validation.Psnr(cloud, kNear), 50);
}

}  // namespace
}  // namespace nerf
