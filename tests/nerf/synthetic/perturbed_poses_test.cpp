#include "nerf/synthetic/perturbed_poses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "nerf/synthetic/camera_rings.h"
#include "nerf/synthetic/scenario.h"
#include "nerf/synthetic/sparse_points.h"

namespace nerf::synthetic {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;

// The squared error of a camera in units of the documented standard deviations.
double SquaredError(const Isometry3d& truth, const Isometry3d& perturbed) {
  const Vector3d shift = perturbed.translation() - truth.translation();
  const AngleAxisd turn(perturbed.linear() * truth.linear().transpose());
  return shift.squaredNorm() / (0.012 * 0.012) +
         turn.angle() * turn.angle() / (0.4 * kDegree * 0.4 * kDegree);
}

class PerturbedPoses : public testing::Test {
 protected:
  const PosedImages truth_ = CameraRings({});
  const PosedImages perturbed_ = WithPerturbedPoses(truth_, 3);

  // The sum over all perturbed cameras after a change of their perturbed poses.
  double Total(const std::function<Isometry3d(const Isometry3d&)>& change) const {
    double total = 0;
    for (int i = 0; i < static_cast<int>(truth_.images.size()); ++i) {
      if (IsHeldOut(i)) continue;
      total += SquaredError(truth_.images[i].world_from_camera,
                            change(perturbed_.images[i].world_from_camera));
    }
    return total;
  }
};

TEST_F(PerturbedPoses, HaveTheDocumentedErrorExceptHeldOutOnes) {
  int perturbed = 0;
  for (int i = 0; i < static_cast<int>(truth_.images.size()); ++i) {
    const bool same =
        truth_.images[i].world_from_camera.isApprox(perturbed_.images[i].world_from_camera, 1e-15);
    EXPECT_EQ(same, IsHeldOut(i)) << i;
    if (!same) ++perturbed;
  }
  // Six degrees of freedom per camera, less the seven of a similarity.
  const double expected = 6.0 * perturbed - 7;
  EXPECT_NEAR(Total([](const Isometry3d& pose) { return pose; }), expected,
              4 * std::sqrt(2 * expected));
}

TEST_F(PerturbedPoses, AreNotImprovedByASimilarity) {
  const double unchanged = Total([](const Isometry3d& pose) { return pose; });
  for (const double step : {-1e-3, 1e-3}) {
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d along = Vector3d::Unit(axis);
      EXPECT_GT(Total([&](Isometry3d pose) {
                  pose.translation() += step * along;
                  return pose;
                }),
                unchanged);
      EXPECT_GT(Total([&](const Isometry3d& pose) { return AngleAxisd(step, along) * pose; }),
                unchanged);
    }
    EXPECT_GT(Total([&](Isometry3d pose) {
                pose.translation() *= 1 + step;
                return pose;
              }),
              unchanged);
  }
}

TEST_F(PerturbedPoses, DependOnTheSeedAlone) {
  const Isometry3d one = perturbed_.images[1].world_from_camera;
  EXPECT_TRUE(WithPerturbedPoses(truth_, 3).images[1].world_from_camera.isApprox(one, 0));
  EXPECT_FALSE(WithPerturbedPoses(truth_, 4).images[1].world_from_camera.isApprox(one, 1e-6));
}

TEST_F(PerturbedPoses, ChangeReprojectionErrorsButNotPoints) {
  PosedImages truth = truth_;
  SampleOptions options;
  options.scenario = Scenario::kPoseRefinement;
  truth.points = SparsePoints(SceneFor(options.scenario), truth, options);
  const PosedImages perturbed = WithPerturbedPoses(truth, 3);
  double before = 0, after = 0;
  for (std::size_t p = 0; p < truth.points.size(); ++p) {
    EXPECT_EQ(perturbed.points[p].x_in_world, truth.points[p].x_in_world);
    EXPECT_EQ(perturbed.points[p].track[0].pixel, truth.points[p].track[0].pixel);
    before += truth.points[p].reprojection_error;
    after += perturbed.points[p].reprojection_error;
  }
  EXPECT_GT(after, 4 * before);
}

}  // namespace
}  // namespace nerf::synthetic
