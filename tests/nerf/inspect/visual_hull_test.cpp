#include "nerf/inspect/visual_hull.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nerf/image/image_io.h"
#include "nerf/scene/camera.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using Eigen::Vector3d;

// A ball before six cameras along the axes, cut out by alpha.
struct CutOutBall {
  test::ScratchFolder folder;
  PosedImages posed;

  CutOutBall(const Vector3d& centre, double radius, bool see_through = true) {
    posed.cameras = {PinholeFromFov(120, 120, 1.0)};
    for (int i = 0; i < 6; ++i) {
      const Vector3d from = (i % 2 ? 4.0 : -4.0) * Vector3d::Unit(i / 2);
      PosedImage image;
      image.name = std::to_string(i) + ".png";
      image.path = folder.path() / image.name;
      image.world_from_camera = Eigen::Isometry3d::Identity();
      image.world_from_camera.translation() = from;
      image.world_from_camera.linear() =
          Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), -from).toRotationMatrix();
      Image photo(120, 120, 4);
      for (int y = 0; y < 120; ++y) {
        for (int x = 0; x < 120; ++x) {
          const Vector3d d = image.world_from_camera.linear() *
                             *DirectionFromPixel(posed.cameras[0], {x + 0.5, y + 0.5});
          const Vector3d aside = (centre - from) - (centre - from).dot(d) * d;
          photo.At(x, y)[3] = !see_through || aside.norm() < radius ? 1.0f : 0.0f;
        }
      }
      WriteImage(image.path, photo);
      posed.images.push_back(image);
    }
  }
};

TEST(BoundingBallOfHull, EnclosesTheObjectTightly) {
  const Vector3d centre(0.3, -0.2, 0.1);
  const CutOutBall object(centre, 0.5);
  const auto ball = BoundingBallOfHull(object.posed, SceneNormalization());
  ASSERT_TRUE(ball);
  EXPECT_LT((ball->centre - centre).norm(), 0.08);
  EXPECT_GT(ball->radius, 0.5);
  // Six silhouettes leave a box with its edges cut; cells are a sixteenth of a unit.
  EXPECT_LT(ball->radius, 0.5 * std::sqrt(3.0) + 0.2);
}

TEST(BoundingBallOfHull, IsNoneWhereNothingIsTransparent) {
  const CutOutBall object(Vector3d::Zero(), 0.5, false);
  EXPECT_FALSE(BoundingBallOfHull(object.posed, SceneNormalization()));
}

TEST(BoundingBallOfHull, BecomesTheUnitBall) {
  SceneNormalization frame;
  frame.scale = 0.7;
  frame.translation = {1, 2, 3};
  const Ball ball = {{0.3, -0.2, 0.1}, 0.6};
  const SceneNormalization fitted = NormalizedTo(ball, frame);
  const Vector3d centre = frame.WorldFromNormalized(ball.centre);
  const Vector3d surface = frame.WorldFromNormalized(ball.centre + Vector3d(0, 0.6, 0));
  EXPECT_LT(fitted.NormalizedFromWorld(centre).norm(), 1e-12);
  EXPECT_LT((fitted.NormalizedFromWorld(surface) - Vector3d::UnitY()).norm(), 1e-12);
}

}  // namespace
}  // namespace nerf
