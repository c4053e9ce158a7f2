#include "sfm/pose_consistency.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "sfm/pair_selection.h"
#include "tests/support/feature_scene.h"

namespace nerf::sfm {
namespace {

using Eigen::Isometry3d;
using testing::HasSubstr;

// The cameras of a film: around a place, at changing distance, and not all at one point.
class Poses : public testing::Test {
 protected:
  Poses() {
    test::FeatureScene scene({.images = 12, .points = 120, .arc = 0.35});
    posed_ = scene.posed;
    std::mt19937 generator(1);
    std::normal_distribution<double> gauss(0, 0.1);
    for (std::size_t i = 0; i < posed_.images.size(); ++i) {
      Isometry3d& pose = posed_.images[i].world_from_camera;
      pose.translation() *= 0.8 + 0.04 * static_cast<double>(i);
      pose.rotate(Eigen::AngleAxisd(gauss(generator), Eigen::Vector3d::UnitX()) *
                  Eigen::AngleAxisd(gauss(generator), Eigen::Vector3d::UnitY()));
    }
    const auto project = [&](int image, const Eigen::Vector3d& x) {
      const PosedImage& of = posed_.images[image];
      return PixelFromPoint(posed_.cameras[0], of.world_from_camera.inverse() * x);
    };
    for (const ImagePair& pair : AllPairs(12)) {
      if (pair.second - pair.first > 4) continue;
      SeenTwice seen{pair, {}, {}};
      for (const Eigen::Vector3d& x : scene.points) {
        const auto a = project(pair.first, x), b = project(pair.second, x);
        if (!a || !b) continue;
        seen.in_first.push_back(*a + Eigen::Vector2d(gauss(generator), gauss(generator)));
        seen.in_second.push_back(*b + Eigen::Vector2d(gauss(generator), gauss(generator)));
      }
      matches_.push_back(seen);
    }
  }

  PoseConsistency Check() const { return CheckPoses(posed_, matches_); }
  // Check says that it looks like this.
  void ExpectMistake(const std::string& text) const {
    const PoseConsistency found = Check();
    EXPECT_TRUE(found.IsDoubtful());
    EXPECT_THAT(found.looks_like, HasSubstr(text));
    EXPECT_GT(found.share_then, 0.85);
    EXPECT_THAT(Describe(found), HasSubstr(text));
  }
  void ChangePoses(const std::function<Isometry3d(const Isometry3d&)>& change) {
    for (PosedImage& image : posed_.images) {
      image.world_from_camera = change(image.world_from_camera);
    }
  }
  void ReorderPoses(const std::function<int(int)>& from) {
    std::vector<Isometry3d> poses;
    for (const PosedImage& image : posed_.images) poses.push_back(image.world_from_camera);
    for (int i = 0; i < static_cast<int>(poses.size()); ++i) {
      posed_.images[i].world_from_camera = poses[from(i)];
    }
  }

  PosedImages posed_;
  std::vector<SeenTwice> matches_;
};

TEST_F(Poses, ThatAreRightFit) {
  const PoseConsistency found = Check();
  EXPECT_GT(found.share, 0.99);
  EXPECT_FALSE(found.IsDoubtful());
  EXPECT_EQ(found.looks_like, "");
}

TEST_F(Poses, ThatAreALittleWrongStillServe) {
  std::mt19937 generator(2);
  std::normal_distribution<double> gauss(0, 0.002);
  ChangePoses([&](Isometry3d pose) {
    pose.rotate(Eigen::AngleAxisd(gauss(generator), Eigen::Vector3d::UnitX()));
    return pose;
  });
  EXPECT_FALSE(Check().IsDoubtful());
}

TEST_F(Poses, InvertedAreNamed) {
  ChangePoses([](const Isometry3d& pose) { return pose.inverse(); });
  ExpectMistake("world-to-camera");
}

// As from a transforms.json, whose axes are turned after it is read.
TEST_F(Poses, InvertedAndTurnedAreNamed) {
  const Eigen::AngleAxisd turn(std::numbers::pi, Eigen::Vector3d::UnitX());
  ChangePoses([&](const Isometry3d& pose) { return (pose * turn).inverse() * turn; });
  ExpectMistake("world-to-camera");
}

TEST_F(Poses, OfOtherAxesAreNamed) {
  ChangePoses([](const Isometry3d& pose) {
    return pose * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX());
  });
  ExpectMistake("OpenGL and OpenCV");
}

TEST_F(Poses, WithAMirroredAxisAreNamed) {
  ChangePoses([](Isometry3d pose) {
    pose.translation().z() *= -1;
    return pose;
  });
  ExpectMistake("the z axis of the positions is mirrored");
}

TEST_F(Poses, OfMirroredPhotographsAreNamed) {
  for (SeenTwice& seen : matches_) {
    for (auto& pixel : seen.in_first) pixel.x() = 640 - pixel.x();
    for (auto& pixel : seen.in_second) pixel.x() = 640 - pixel.x();
  }
  ExpectMistake("x axis of the cameras");
}

TEST_F(Poses, OfAFocalLengthThatIsAFifthWrongAreNamed) {
  for (const double factor : {0.8, 1.2}) {
    const Camera right = posed_.cameras[0];
    posed_.cameras[0].params[0] *= factor;
    posed_.cameras[0].params[1] *= factor;
    const PoseConsistency found = Check();
    EXPECT_TRUE(found.IsDoubtful());
    int percent = 0;
    ASSERT_EQ(std::sscanf(found.looks_like.c_str(), "the focal length is %d", &percent), 1)
        << found.looks_like;
    EXPECT_NEAR(percent, 100 * factor, 4);
    posed_.cameras[0] = right;
  }
}

TEST_F(Poses, OfOtherNamesAreNamed) {
  ReorderPoses([](int i) { return 11 - i; });
  ExpectMistake("reverse order");
  ReorderPoses([](int i) { return 11 - i; });
  ReorderPoses([](int i) { return (i + 1) % 12; });
  ExpectMistake("shifted");
}

TEST_F(Poses, ThatAreShuffledAreRefusedWithoutAGuess) {
  const int order[] = {7, 2, 11, 0, 5, 9, 1, 10, 3, 8, 4, 6};
  ReorderPoses([&](int i) { return order[i]; });
  const PoseConsistency found = Check();
  EXPECT_TRUE(found.Contradicts());
  EXPECT_EQ(found.looks_like, "");
  EXPECT_THAT(Describe(found), HasSubstr("shuffled"));
}

// A camera that only turns has no epipolar lines.
TEST_F(Poses, AtOnePlaceCannotBeTold) {
  ChangePoses([](Isometry3d pose) {
    pose.translation().setConstant(2);
    return pose;
  });
  EXPECT_TRUE(std::isnan(Check().share));
}

TEST_F(Poses, OfHardlyAnyMatchesCannotBeTold) {
  matches_.resize(1);
  matches_[0].in_first.resize(5);
  matches_[0].in_second.resize(5);
  const PoseConsistency found = Check();
  EXPECT_TRUE(std::isnan(found.share));
  EXPECT_FALSE(found.IsDoubtful());
  EXPECT_THAT(Describe(found), HasSubstr("too few matches"));
}

}  // namespace
}  // namespace nerf::sfm
