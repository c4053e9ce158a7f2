#include "nerf/synthetic/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "nerf/image/image_io.h"
#include "nerf/scene/camera.h"
#include "nerf/synthetic/camera_rings.h"
#include "nerf/synthetic/capture.h"
#include "nerf/synthetic/sample_folder.h"
#include "nerf/synthetic/sparse_points.h"
#include "sfm/colmap_model.h"
#include "sfm/transforms_json.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf::synthetic {
namespace {

SampleOptions Tiny(Scenario scenario) {
  SampleOptions options;
  options.scenario = scenario;
  options.views = 9;
  options.width = 48;
  options.height = 36;
  options.samples_per_pixel = 4;
  return options;
}

TEST(Scenario, HasANameAndAcceptsFormerNames) {
  EXPECT_EQ(ScenarioFromName("exposure"), Scenario::kExposure);
  EXPECT_EQ(ScenarioFromName("anti_aliasing"), Scenario::kAntiAliasing);
  for (const auto& [former, scenario] : {std::pair("view", Scenario::kViewDependence),
                                         {"poses", Scenario::kPoseRefinement},
                                         {"footprint", Scenario::kAntiAliasing},
                                         {"depth", Scenario::kDepthSupervision}}) {
    EXPECT_EQ(ScenarioFromName(former), scenario);
    EXPECT_EQ((", " + ScenarioNames() + ",").find(fmt::format(", {},", former)), std::string::npos);
  }
  EXPECT_THAT(test::InputErrorOf([] { ScenarioFromName("rain"); }),
              testing::AllOf(testing::HasSubstr("rain"), testing::HasSubstr("exposure")));
}

TEST(Scenario, NothingIsDiffuseAndHasNoGaps) {
  const Capture capture = MakeCapture(Tiny(Scenario::kNothing));
  for (const Object& object : SceneFor(Scenario::kNothing).objects) {
    EXPECT_TRUE(object.material.mirror.isZero());
    EXPECT_TRUE(object.material.gloss.isZero());
  }
  for (const View& view : capture.views) {
    for (const float depth : view.depth.pixels) EXPECT_GT(depth, 0);
  }
}

TEST(Scenario, DepthSupervisionHasFewPhotographs) {
  EXPECT_LT(DefaultViewCount(Scenario::kDepthSupervision),
            DefaultViewCount(Scenario::kNothing) / 3);
}

TEST(Scenario, ExposureChangesTheBrightnessAlone) {
  const SampleOptions plain = Tiny(Scenario::kNothing), drift = Tiny(Scenario::kExposure);
  const Capture a = MakeCapture(plain), b = MakeCapture(drift);
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    EXPECT_EQ(a.views[i].depth.pixels, b.views[i].depth.pixels);
    const Color gain = PhotoSettingsFor(Scenario::kExposure, static_cast<int>(i), drift.seed,
                                        a.posed.images[i].world_from_camera)
                           .gain;
    const Image one = ToLinear(a.views[i].photo), other = ToLinear(b.views[i].photo);
    for (std::size_t k = 0; k < one.pixels.size(); ++k) {
      if (one.pixels[k] >= 1 || other.pixels[k] >= 1) continue;
      ASSERT_NEAR(other.pixels[k], gain[static_cast<int>(k % 3)] * one.pixels[k], 1e-4);
    }
  }
}

TEST(Scenario, RobustHasNoPassersByInHeldOutPhotographs) {
  const Capture plain = MakeCapture(Tiny(Scenario::kNothing));
  const Capture passed = MakeCapture(Tiny(Scenario::kRobust));
  int changed = 0;
  for (std::size_t i = 0; i < plain.views.size(); ++i) {
    const bool same = plain.views[i].photo.pixels == passed.views[i].photo.pixels;
    if (i % 8 == 0) {
      EXPECT_TRUE(same) << i;
    }
    if (!same) ++changed;
    // Ground truth does not include passers-by.
    EXPECT_EQ(plain.views[i].depth.pixels, passed.views[i].depth.pixels);
    EXPECT_FALSE(passed.views[i].mask);
  }
  EXPECT_GE(changed, 6);
}

TEST(Scenario, MasksHideATwelfthOfEachPhotograph) {
  SampleOptions options = Tiny(Scenario::kMasks);
  options.views = 36;
  options.width = 160;
  options.height = 120;
  options.samples_per_pixel = 1;
  const Capture capture = MakeCapture(options);
  double hidden = 0, pixels = 0;
  for (int i = 0; i < options.views; ++i) {
    const auto people = PhotoSettingsFor(options.scenario, i, options.seed,
                                         capture.posed.images[i].world_from_camera)
                            .passers_by.size();
    if (IsHeldOut(i)) {
      EXPECT_EQ(people, 0u);
      continue;
    }
    EXPECT_TRUE(people == 2 || people == 3) << people;
    for (const float shown : capture.views[i].mask->pixels) hidden += shown == 0;
    pixels += static_cast<double>(capture.views[i].mask->pixels.size());
  }
  EXPECT_GT(hidden / pixels, 0.07);
  EXPECT_LT(hidden / pixels, 0.11);
}

TEST(Scenario, ViewDependenceIsGlossyWithoutMirrors) {
  int glossy = 0;
  for (const Object& object : SceneFor(Scenario::kViewDependence).objects) {
    EXPECT_TRUE(object.material.mirror.isZero());
    glossy += !object.material.gloss.isZero();
  }
  EXPECT_GE(glossy, 5);
}

TEST(Scenario, MasksCoverAllPassersBy) {
  const Capture plain = MakeCapture(Tiny(Scenario::kNothing));
  const Capture masked = MakeCapture(Tiny(Scenario::kMasks));
  int hidden = 0;
  for (std::size_t i = 0; i < plain.views.size(); ++i) {
    ASSERT_TRUE(masked.views[i].mask);
    for (std::size_t p = 0; p < masked.views[i].mask->pixels.size(); ++p) {
      if (masked.views[i].mask->pixels[p] == 0) {
        ++hidden;
        continue;
      }
      // Shadows of passers-by are not masked: other pixels may be darker, but not brighter.
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_LE(masked.views[i].photo.pixels[3 * p + c],
                  plain.views[i].photo.pixels[3 * p + c] + 1e-6);
      }
    }
  }
  EXPECT_GT(hidden, 100);
}

TEST(Scenario, AntiAliasingAlternatesNearAndFar) {
  SampleOptions options = Tiny(Scenario::kAntiAliasing);
  options.views = 36;
  options.samples_per_pixel = 1;
  const Capture capture = MakeCapture(options);
  int far = 0, far_held_out = 0, held_out = 0;
  for (int i = 0; i < options.views; ++i) {
    const double distance = capture.posed.images[i].world_from_camera.translation().norm();
    EXPECT_NEAR(distance, distance > 6 ? 12 : 3, 0.06 * distance);
    far += distance > 6;
    held_out += IsHeldOut(i);
    far_held_out += IsHeldOut(i) && distance > 6;
  }
  EXPECT_NEAR(far, options.views / 2, 2);
  EXPECT_GE(far_held_out, 2);
  EXPECT_GE(held_out - far_held_out, 2);
}

TEST(Scenario, AlphaIsTransparentBesideTheSubject) {
  const Capture capture = MakeCapture(Tiny(Scenario::kAlpha));
  const Capture plain = MakeCapture(Tiny(Scenario::kNothing));
  int clear = 0, opaque = 0, missed = 0;
  for (std::size_t i = 0; i < capture.views.size(); ++i) {
    const Image& photo = capture.views[i].photo;
    ASSERT_EQ(photo.channels, 4);
    for (std::size_t p = 0; p < capture.views[i].depth.pixels.size(); ++p) {
      const float alpha = photo.pixels[4 * p + 3];
      if (capture.views[i].depth.pixels[p] == 0) {
        clear += alpha == 0;
        missed += alpha == 1;
      }
      if (alpha < 1) continue;
      // Opaque pixels are those of the picture without alpha.
      ++opaque;
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(LinearFromSrgb(photo.pixels[4 * p + c]),
                    LinearFromSrgb(plain.views[i].photo.pixels[3 * p + c]), 1e-3);
      }
    }
  }
  EXPECT_GT(clear, 100);
  EXPECT_GT(opaque, 100);
  EXPECT_LT(missed, clear / 100);  // at edges, where only the centre of a pixel hits nothing
}

TEST(Scenario, HdrIsBrighterThanWhite) {
  const Capture capture = MakeCapture(Tiny(Scenario::kHdr));
  EXPECT_EQ(capture.views[0].photo.encoding, ColorEncoding::kLinear);
  EXPECT_GT(*std::ranges::max_element(capture.views[0].photo.pixels), 2);
}

TEST(SparsePoints, HaveTracksInsideThePhotographs) {
  const SampleOptions options = Tiny(Scenario::kBuiltIn);
  const Capture capture = MakeCapture(options);
  const auto points = SparsePoints(SceneFor(options.scenario), capture.posed, options);
  ASSERT_GT(points.size(), 500u);
  for (const SparsePoint& point : points) {
    EXPECT_GE(point.track.size(), 3u);
    for (const TrackElement& seen : point.track) {
      const auto x = static_cast<int>(seen.pixel.x()), y = static_cast<int>(seen.pixel.y());
      EXPECT_TRUE(x >= 0 && y >= 0 && x < options.width && y < options.height);
    }
  }
}

TEST(SparsePoints, AreHiddenByPassersByAlone) {
  SampleOptions options = Tiny(Scenario::kMasks);
  options.width = 160;
  options.height = 120;
  options.samples_per_pixel = 1;
  const Capture capture = MakeCapture(options);
  const PosedImages& posed = capture.posed;
  const auto points = SparsePoints(SceneFor(options.scenario), posed, options);
  int seen_unmasked = 0;
  for (const SparsePoint& point : points) {
    for (const TrackElement& seen : point.track) {
      const auto pixel =
          PixelFromPoint(posed.cameras[0],
                         posed.images[seen.image].world_from_camera.inverse() * point.x_in_world);
      const auto x = static_cast<int>(pixel->x()), y = static_cast<int>(pixel->y());
      seen_unmasked += *capture.views[seen.image].mask->At(x, y) == 1;
    }
  }
  std::size_t sightings = 0, without_passers_by = 0;
  options.scenario = Scenario::kNothing;
  for (const auto& point : points) sightings += point.track.size();
  for (const auto& point : SparsePoints(SceneFor(options.scenario), posed, options)) {
    without_passers_by += point.track.size();
  }
  // Nearly all are outside the masks, which are a pixel larger, and few are lost.
  EXPECT_GT(seen_unmasked, 0.98 * sightings);
  EXPECT_GT(sightings, 0.85 * without_passers_by);
}

TEST(WriteSample, WritesMasksAndRemovesThoseOfAnEarlierSample) {
  const test::ScratchFolder folder;
  WriteSample(folder.path(), Tiny(Scenario::kMasks));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "masks" / "view_001.png"));
  WriteSample(folder.path(), Tiny(Scenario::kHdr));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "masks"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "images" / "view_001.exr"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "images" / "view_001.png"));
}

TEST(WriteSample, WritesPerturbedAndTruePoses) {
  const test::ScratchFolder folder;
  const SampleOptions options = Tiny(Scenario::kPoseRefinement);
  WriteSample(folder.path(), options);
  const PosedImages truth = CameraRings(options);
  const auto right = sfm::ReadTransformsJson(folder.path() / "truth" / "poses.json").images;
  const auto wrong = sfm::ReadTransformsJson(folder.path() / "truth" / "transforms.json").images;
  const auto sparse =
      sfm::ReadColmapModel(folder.path() / "truth" / "sparse", folder.path() / "images").images;
  ASSERT_EQ(right.size(), truth.images.size());
  for (std::size_t i = 0; i < truth.images.size(); ++i) {
    const Eigen::Isometry3d& pose = truth.images[i].world_from_camera;
    EXPECT_TRUE(right[i].world_from_camera.isApprox(pose, 1e-12));
    EXPECT_EQ(wrong[i].world_from_camera.isApprox(pose, 1e-12), IsHeldOut(static_cast<int>(i)));
    EXPECT_TRUE(sparse[i].world_from_camera.isApprox(wrong[i].world_from_camera, 1e-9));
  }
  WriteSample(folder.path(), Tiny(Scenario::kNothing));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "truth" / "poses.json"));
}

}  // namespace
}  // namespace nerf::synthetic
