#include "nerf/sample/occasion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "nerf/data/image_io.h"
#include "nerf/sample/capture.h"
#include "nerf/sample/sample_folder.h"
#include "nerf/sample/sparse_points.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf::sample {
namespace {

SampleOptions Tiny(Occasion occasion) {
  SampleOptions options;
  options.occasion = occasion;
  options.views = 9;
  options.width = 48;
  options.height = 36;
  options.samples_per_pixel = 4;
  return options;
}

TEST(Occasion, HasANameThatAPersonUses) {
  EXPECT_EQ(OccasionFromName("exposure"), Occasion::kExposure);
  EXPECT_THAT(test::InputErrorOf([] { OccasionFromName("rain"); }),
              testing::AllOf(testing::HasSubstr("rain"), testing::HasSubstr("exposure")));
}

TEST(Occasion, OfNothingShowsMattThingsAndSomethingEverywhere) {
  const Capture capture = MakeCapture(Tiny(Occasion::kNothing));
  for (const Object& object : SceneOf(Occasion::kNothing).objects) {
    EXPECT_TRUE(object.material.mirror.isZero());
  }
  for (const View& view : capture.views) {
    for (const float depth : view.depth.pixels) EXPECT_GT(depth, 0);
  }
}

TEST(Occasion, OfDepthHasFewPhotographs) {
  EXPECT_LT(UsualViews(Occasion::kDepth), UsualViews(Occasion::kNothing) / 3);
}

TEST(Occasion, OfExposureChangesLightAndNothingElse) {
  const SampleOptions plain = Tiny(Occasion::kNothing), drift = Tiny(Occasion::kExposure);
  const Capture a = MakeCapture(plain), b = MakeCapture(drift);
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    EXPECT_EQ(a.views[i].depth.pixels, b.views[i].depth.pixels);
    const Color gain = PhotographyOf(Occasion::kExposure, static_cast<int>(i), drift.seed,
                                     a.posed.images[i].world_from_camera)
                           .gain;
    const Image one = ToLinear(a.views[i].photo), other = ToLinear(b.views[i].photo);
    for (std::size_t k = 0; k < one.pixels.size(); ++k) {
      if (one.pixels[k] >= 1 || other.pixels[k] >= 1) continue;
      ASSERT_NEAR(other.pixels[k], gain[static_cast<int>(k % 3)] * one.pixels[k], 1e-4);
    }
  }
}

TEST(Occasion, OfRobustLeavesEveryEighthPhotographToJudgeBy) {
  const Capture plain = MakeCapture(Tiny(Occasion::kNothing));
  const Capture passed = MakeCapture(Tiny(Occasion::kRobust));
  int changed = 0;
  for (std::size_t i = 0; i < plain.views.size(); ++i) {
    const bool same = plain.views[i].photo.pixels == passed.views[i].photo.pixels;
    if (i % 8 == 0) {
      EXPECT_TRUE(same) << i;
    }
    if (!same) ++changed;
    // What is true of the scene is true without them.
    EXPECT_EQ(plain.views[i].depth.pixels, passed.views[i].depth.pixels);
    EXPECT_FALSE(passed.views[i].mask);
  }
  EXPECT_GE(changed, 6);
}

TEST(Occasion, OfMasksMarksEveryPixelInWhichSomebodyIs) {
  const Capture plain = MakeCapture(Tiny(Occasion::kNothing));
  const Capture masked = MakeCapture(Tiny(Occasion::kMasks));
  int hidden = 0;
  for (std::size_t i = 0; i < plain.views.size(); ++i) {
    ASSERT_TRUE(masked.views[i].mask);
    for (std::size_t p = 0; p < masked.views[i].mask->pixels.size(); ++p) {
      if (masked.views[i].mask->pixels[p] == 0) {
        ++hidden;
        continue;
      }
      // Of their shadows nothing is said: what is left may be darker, and is no other colour.
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_LE(masked.views[i].photo.pixels[3 * p + c],
                  plain.views[i].photo.pixels[3 * p + c] + 1e-6);
      }
    }
  }
  EXPECT_GT(hidden, 100);
}

TEST(Occasion, OfAlphaIsTransparentWhereNothingIsMet) {
  const Capture capture = MakeCapture(Tiny(Occasion::kAlpha));
  const Capture plain = MakeCapture(Tiny(Occasion::kNothing));
  int clear = 0, opaque = 0;
  for (std::size_t i = 0; i < capture.views.size(); ++i) {
    const Image& photo = capture.views[i].photo;
    ASSERT_EQ(photo.channels, 4);
    for (std::size_t p = 0; p < capture.views[i].depth.pixels.size(); ++p) {
      const float alpha = photo.pixels[4 * p + 3];
      if (capture.views[i].depth.pixels[p] == 0) {
        EXPECT_LT(alpha, 1);
        clear += alpha == 0;
      }
      if (alpha < 1) continue;
      // Where all of a pixel is the subject, it is the picture without alpha.
      ++opaque;
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(LinearFromSrgb(photo.pixels[4 * p + c]),
                    LinearFromSrgb(plain.views[i].photo.pixels[3 * p + c]), 1e-3);
      }
    }
  }
  EXPECT_GT(clear, 100);
  EXPECT_GT(opaque, 100);
}

TEST(Occasion, OfHdrIsBrighterThanWhite) {
  const Capture capture = MakeCapture(Tiny(Occasion::kHdr));
  EXPECT_EQ(capture.views[0].photo.encoding, ColorEncoding::kLinear);
  EXPECT_GT(*std::ranges::max_element(capture.views[0].photo.pixels), 2);
}

TEST(SparsePoints, AreSeenWhereTheirTracksSay) {
  const SampleOptions options = Tiny(Occasion::kBuiltIn);
  const Capture capture = MakeCapture(options);
  const auto points = SparsePoints(SceneOf(options.occasion), capture.posed, options);
  ASSERT_GT(points.size(), 500u);
  for (const sfm::SparsePoint& point : points) {
    EXPECT_GE(point.track.size(), 3u);
    for (const sfm::TrackElement& seen : point.track) {
      const auto x = static_cast<int>(seen.pixel.x()), y = static_cast<int>(seen.pixel.y());
      EXPECT_TRUE(x >= 0 && y >= 0 && x < options.width && y < options.height);
    }
  }
}

TEST(WriteSample, WithMasksWritesThemAndTakesThemAwayAgain) {
  const test::ScratchFolder folder;
  WriteSample(folder.path(), Tiny(Occasion::kMasks));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "masks" / "view_001.png"));
  WriteSample(folder.path(), Tiny(Occasion::kHdr));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "masks"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "images" / "view_001.exr"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "images" / "view_001.png"));
}

}  // namespace
}  // namespace nerf::sample
