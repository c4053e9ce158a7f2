#include <gtest/gtest.h>

#include "nerf/effects/effects.h"
#include "nerf/effects/view_dependence.h"
#include "nerf/inspect/photograph_fit.h"
#include "nerf/inspect/track_colors.h"
#include "nerf/inspect/verdict.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Cameras on a line at these distances from points near the origin, which all of them see.
PosedImages CamerasAtDistances(const std::vector<double>& distances) {
  PosedImages posed;
  posed.cameras = {PinholeFromFov(640, 480, 0.9)};
  for (const double distance : distances) {
    PosedImage image;
    image.world_from_camera = Eigen::Translation3d(0, 0, -distance);
    posed.images.push_back(image);
  }
  for (int k = 0; k < 60; ++k) {
    SparsePoint point;
    point.x_in_world = Vector3d(0.01 * k, -0.005 * k, 0);
    for (int i = 0; i < static_cast<int>(distances.size()); ++i) {
      const auto pixel = PixelFromPoint(
          posed.cameras[0], posed.images[i].world_from_camera.inverse() * point.x_in_world);
      point.track.push_back({i, *pixel});
    }
    posed.points.push_back(point);
  }
  return posed;
}

void MovePixels(PosedImages& posed, const Vector2d& by) {
  for (auto& point : posed.points) {
    for (auto& seen : point.track) seen.pixel += by;
  }
}

// Of 60 points that all of 18 cameras could see, those of few sightings are what a matcher has
// found to look alike: hardly any change in colour is then no evidence against gloss.
TEST(ViewDependenceVerdict, OfMatchedPointsIsInconclusiveUnlessHardlyAnyChange) {
  const PosedImages complete = CamerasAtDistances(std::vector<double>(18, 2.0));
  PosedImages matched = complete;
  for (SparsePoint& point : matched.points) point.track.resize(5);
  const auto judge = [](const PosedImages& posed, int changing) {
    TrackColors colors;
    PhotographFit fit;
    for (int point = 0; point < 60; ++point) {
      for (int photograph = 0; photograph < 5; ++photograph) {
        colors.seen.push_back({point, photograph, Eigen::Vector3f::Zero(), 0.0f});
        fit.residuals.push_back(Eigen::Vector3f::Constant(point < changing ? 0.5f : 0.0f));
      }
    }
    return JudgeViewDependence(colors, fit, posed);
  };
  EXPECT_TRUE(judge(complete, 4).IsConclusive());
  EXPECT_FALSE(judge(complete, 4).on);
  EXPECT_FALSE(judge(matched, 4).IsConclusive());
  EXPECT_TRUE(judge(matched, 0).IsConclusive());
  EXPECT_TRUE(judge(matched, 20).on);
  EXPECT_TRUE(judge(matched, 20).IsConclusive());
}

TEST(PoseRefinementVerdict, IsTheReprojectionError) {
  PosedImages posed = CamerasAtDistances({2, 2, 2, 2});
  EXPECT_NEAR(JudgePoseRefinement(posed).figure, 0, 1e-9);
  MovePixels(posed, {0.6, 0.8});
  EXPECT_NEAR(JudgePoseRefinement(posed).figure, 1, 1e-9);
  EXPECT_FALSE(JudgePoseRefinement(posed).on);
  MovePixels(posed, {0.6, 0.8});
  EXPECT_NEAR(JudgePoseRefinement(posed).figure, 2, 1e-9);
  EXPECT_TRUE(JudgePoseRefinement(posed).on);
  EXPECT_EQ(JudgePoseRefinement(posed).assignment, "effects.pose_refinement={}");
}

TEST(PoseRefinementVerdict, IsRobustToAFewOutliers) {
  PosedImages posed = CamerasAtDistances({2, 2, 2, 2});
  for (std::size_t p = 0; p < 20; ++p) posed.points[p].track[0].pixel += Vector2d(90, 0);
  EXPECT_NEAR(JudgePoseRefinement(posed).figure, 0, 1e-9);
}

TEST(AntiAliasingVerdict, IsTheRatioOfDistances) {
  EXPECT_NEAR(JudgeAntiAliasing(CamerasAtDistances({2, 2, 2, 2})).figure, 1, 1e-9);
  const Verdict far = JudgeAntiAliasing(CamerasAtDistances({2, 8, 2, 8, 2, 8}));
  EXPECT_NEAR(far.figure, 4, 0.1);
  EXPECT_TRUE(far.on);
  EXPECT_EQ(far.assignment, "effects.anti_aliasing={}");
}

// Four times the focal length compensates for four times the distance.
TEST(AntiAliasingVerdict, TakesTheFocalLengthIntoAccount) {
  PosedImages posed = CamerasAtDistances({2, 8, 2, 8, 2, 8});
  Camera longer = posed.cameras[0];
  for (int i = 0; i < 2; ++i) longer.params[i] *= 4;
  posed.cameras.push_back(longer);
  for (const int i : {1, 3, 5}) posed.images[i].camera = 1;
  EXPECT_NEAR(JudgeAntiAliasing(posed).figure, 1, 0.1);
  EXPECT_FALSE(JudgeAntiAliasing(posed).on);
}

TEST(GeometryVerdicts, AreUndecidedWithoutTracks) {
  PosedImages posed = CamerasAtDistances({2, 2, 2, 2});
  for (auto& point : posed.points) point.track.clear();
  for (const Verdict& verdict : {JudgePoseRefinement(posed), JudgeAntiAliasing(posed)}) {
    EXPECT_FALSE(verdict.decided);
    EXPECT_FALSE(verdict.on);
    EXPECT_EQ(verdict.assignment, "");
    EXPECT_EQ(verdict.Confidence(), 0);
  }
}

}  // namespace
}  // namespace nerf
