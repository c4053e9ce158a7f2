#include "nerf/model/gaussian_model.h"

#include <gtest/gtest.h>

#include "nerf/splats/initial_gaussians.h"

namespace nerf {
namespace {

// One white Gaussian around the camera's axis that fills the picture.
GaussianModel WhiteModel() {
  GaussianCloud cloud =
      GaussiansAtPoints({{Eigen::Vector3d(0, 0, 1), Eigen::Vector3f::Constant(1)}}, 1, 0, 1);
  for (int k = 0; k < 3; ++k) cloud.At(0, kernels::kLogScaleRow + k) = 3;
  return {Config{}, SceneFacts{}, cloud, 0.02, {}};
}

TEST(GaussianModel, IsEmptyOutsideTheCircleOfAFisheye) {
  const Camera camera = {CameraModel::kSimpleRadialFisheye, 100, 100, {20, 50, 50, 0}};
  const GaussianModel model = WhiteModel();
  const RenderedView view = model.Render({camera, Eigen::Isometry3d::Identity(), 1, {}, true});
  EXPECT_GT(*view.opacity.At(50, 50), 0.5f);
  EXPECT_GT(*view.median_depth.At(50, 50), 0);
  EXPECT_EQ(*view.opacity.At(1, 1), 0);
  EXPECT_EQ(*view.depth.At(1, 1), 0);
  EXPECT_EQ(*view.median_depth.At(1, 1), 0);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(view.rgb.At(1, 1)[c], 0);
    EXPECT_EQ(view.normal.At(1, 1)[c], 0);
  }
}

}  // namespace
}  // namespace nerf
