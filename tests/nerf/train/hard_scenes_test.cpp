// Whole trainings on numerically hard scenes: each must end with finite values and a stated
// quality.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <string>

#include "nerf/base/parallel.h"
#include "nerf/image/image_metrics.h"
#include "nerf/model/checkpoint.h"
#include "nerf/model/run_folder.h"
#include "nerf/render/engine.h"
#include "nerf/render/image_renderer.h"
#include "nerf/render/non_finite_error.h"
#include "nerf/render/view_renderer.h"
#include "nerf/scene/scene_normalization.h"
#include "nerf/train/trainer.h"
#include "tests/support/analytic_capture.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/small_capture.h"
#include "tests/support/tiny_training.h"

namespace nerf {
namespace {

using Eigen::Vector3f;
using Eigen::Vector4f;
using test::AnalyticCapture;
using test::CameraRing;
using test::never_stop;
using test::PsnrOver;
using test::Trained;

// As set by a user who knows that nothing is close to the cameras.
constexpr char kNothingNear[] = "march.near_distance=0.8";

double HeldOutPsnr(const AnalyticCapture& capture, const Config& config) {
  return PsnrOver(Trained(config, capture.scene, capture.data), capture.held_out);
}

// The part of a ray inside the ball around the origin; empty if it misses.
struct Chord {
  float begin = 0, end = 0;
  float Length() const { return end - begin; }
};
Chord ThroughBall(const Vector3f& origin, const Vector3f& direction, float radius) {
  const float middle = -origin.dot(direction);
  const float square = radius * radius - (origin + middle * direction).squaredNorm();
  if (square <= 0 || middle + std::sqrt(square) <= 0) return {};
  return {std::max(0.0f, middle - std::sqrt(square)), middle + std::sqrt(square)};
}

// Surroundings that differ by direction.
Vector3f Sky(const Vector3f& d) {
  return Vector3f(0.5f + 0.3f * d.x(), 0.5f + 0.3f * d.y(), 0.5f + 0.3f * d.z());
}

TEST(HardScene, ThinFogKeepsItsOpacity) {
  // A ball of fog with a transmittance of 95 %.
  const auto fog = [](const Vector3f& origin, const Vector3f& direction) {
    const float tau = 0.05f * ThroughBall(origin, direction, 0.5f).Length();
    return Vector4f(1.0f, 0.6f, 0.2f, -std::expm1(-tau));
  };
  const AnalyticCapture capture(CameraRing(24, 1.5, 0.8), 24, 24, fog, /*has_alpha=*/true);
  const Model model = Trained(test::TinyConfig(1000), capture.scene, capture.data);
  EXPECT_GT(PsnrOver(model, capture.held_out), 40);  // an empty field would have 29 dB

  RayBatch through_the_middle;
  through_the_middle.Resize(1);
  through_the_middle.origin = {0, -1.5f, 0};
  through_the_middle.direction = {0, 1, 0};
  through_the_middle.jitter = {0.5f};
  const double opacity = MakeRenderer(model)->Render(through_the_middle).opacity[0];
  EXPECT_NEAR(opacity, -std::expm1(-0.05), 0.25 * 0.05);
}

TEST(HardScene, AMirrorIsReproduced) {
  const auto mirror = [](const Vector3f& origin, const Vector3f& direction) -> Vector4f {
    const Chord chord = ThroughBall(origin, direction, 0.5f);
    if (chord.Length() <= 0) return Sky(direction).homogeneous();
    const Vector3f normal = (origin + chord.begin * direction).normalized();
    return Sky(direction - 2 * direction.dot(normal) * normal).homogeneous();
  };
  const AnalyticCapture capture(CameraRing(96, 1.5, 0.8), 24, 24, mirror);
  EXPECT_GT(HeldOutPsnr(capture, test::TinyConfig(400, {kNothingNear})), 22);
}

TEST(HardScene, ABlackSceneStaysBlackAndAWhiteOneWhite) {
  for (const float value : {0.0f, 1.0f}) {
    for (const bool has_alpha : {false, true}) {
      const auto plain = [value](const Vector3f&, const Vector3f&) {
        return Vector4f(value, value, value, 1.0f);
      };
      const AnalyticCapture capture(CameraRing(12, 1.5, 0.8), 16, 16, plain, has_alpha);
      EXPECT_GT(HeldOutPsnr(capture, test::TinyConfig(200)), 30) << value << " " << has_alpha;
    }
  }
}

TEST(HardScene, AnEmptySceneStaysEmpty) {
  const auto nothing = [](const Vector3f&, const Vector3f&) { return Vector4f(0, 0, 0, 0); };
  const AnalyticCapture capture(CameraRing(12, 1.5, 0.8), 16, 16, nothing, /*has_alpha=*/true);
  EXPECT_GT(HeldOutPsnr(capture, test::TinyConfig(200)), 40);
}

// A striped ball in front of a sky.
Vector4f StripedBall(const Vector3f& origin, const Vector3f& direction) {
  const Chord chord = ThroughBall(origin, direction, 0.5f);
  if (chord.Length() <= 0) return Sky(direction).homogeneous();
  const Vector3f x = origin + chord.begin * direction;
  return Vector4f(0.5f + 0.4f * std::sin(8 * x.x()), 0.5f + 0.4f * std::sin(8 * x.z()), 0.3f, 1.0f);
}

TEST(HardScene, OneOverexposedPhotographDoesNotDegradeTheOthers) {
  AnalyticCapture capture(CameraRing(96, 1.5, 0.8), 24, 24, StripedBall);
  View& bright = capture.data.train[7];
  for (std::size_t i = 0; i < bright.rgba.size(); ++i) {
    if (i % 4 < 3) {
      bright.rgba[i] = Eigen::half(std::min(1.0f, 8 * static_cast<float>(bright.rgba[i])));
    }
  }
  EXPECT_GT(HeldOutPsnr(capture, test::TinyConfig(400, {kNothingNear})), 22);
}

TEST(HardScene, CamerasInsideMatterSeeItsColour) {
  // The first cameras are inside the red ball, the others around it; alpha masks the surroundings.
  const auto red_ball = [](const Vector3f& origin, const Vector3f& direction) {
    const bool hits = ThroughBall(origin, direction, 0.5f).Length() > 0;
    return hits ? Vector4f(0.8f, 0.1f, 0.1f, 1.0f) : Vector4f(0, 0, 0, 0);
  };
  auto cameras = CameraRing(64, 1.5, 0.8);
  for (int i = 0; i < 8; ++i) cameras[i].translation() *= 0.1;
  const AnalyticCapture capture(cameras, 24, 24, red_ball, /*has_alpha=*/true);
  EXPECT_GT(HeldOutPsnr(capture, test::TinyConfig(400)), 20);
}

TEST(HardScene, TwoPhotographsAreReproduced) {
  const AnalyticCapture capture(CameraRing(2, 1.5, 0.1), 32, 32, StripedBall, false, 0);
  ASSERT_EQ(capture.data.train.size(), 2u);
  const Model model = Trained(test::TinyConfig(400), capture.scene, capture.data);
  EXPECT_GT(PsnrOver(model, capture.data.train), 25);
}

TEST(HardScene, TenThousandTinyPhotographsTrain) {
  const AnalyticCapture capture(CameraRing(10000, 1.5, 0.8), 8, 8, StripedBall, false, 100);
  EXPECT_EQ(capture.data.train.size(), 9900u);
  EXPECT_GT(HeldOutPsnr(capture, test::TinyConfig(300)), 22);
}

TEST(HardScene, OnePhotographOfOnePixelTrains) {
  const AnalyticCapture capture(CameraRing(1, 1.5, 0.1), 1, 1, StripedBall, false, 0);
  const Model model =
      Trained(test::TinyConfig(50, {"train.max_rays_per_batch=1"}), capture.scene, capture.data);
  EXPECT_GT(PsnrOver(model, capture.data.train), 20);
}

// Normalisation cancels the units of the input, except for the rounding of poses.
TEST(HardScene, AMillimetreAndTenKilometresTrainAlike) {
  const auto psnr_at = [](double scale) {
    test::SmallCapture small = test::MakeSmallCapture(24, 32, 24);
    for (PosedImage& image : small.capture.posed.images) {
      image.world_from_camera.translation() *= scale;
    }
    small.scene.normalized_from_world = NormalizeScene(small.capture.posed);
    std::size_t of_train = 0;
    for (const PosedImage& image : small.capture.posed.images) {
      if (image.split != Split::kTrain) continue;
      small.data.train[of_train++].normalized_from_camera =
          small.scene.normalized_from_world.NormalizedFromCamera(image.world_from_camera);
    }
    const Model model = Trained(test::TinyConfig(300), small.scene, small.data);
    return PsnrOver(model, small.data.train);
  };
  const double usual = psnr_at(1.0);
  EXPECT_GT(usual, 18);
  // The built-in scene is about four units across.
  EXPECT_NEAR(psnr_at(0.25e-3), usual, 0.1);
  EXPECT_NEAR(psnr_at(0.25e4), usual, 0.1);
}

// Uses a single thread during its lifetime, which is faster for tiny batches.
struct OneThread {
  const int before = NumThreads();
  OneThread() { SetNumThreads(1); }
  ~OneThread() { SetNumThreads(before); }
};

// With far too large learning rates, training must end with finite values or report where it
// diverged, and the last checkpoint must be renderable in both cases.
TEST(HardScene, AHundredThousandStepsWithHugeLearningRatesEndOrReportAReason) {
  const AnalyticCapture capture(CameraRing(4, 1.5, 0.8), 4, 4, StripedBall, true, 0);
  const OneThread one;
  for (const char* rate : {"optimizer.learning_rate=1", "optimizer.learning_rate=1e6"}) {
    const test::ScratchFolder run;
    const Config config = test::TinyConfig(
        100000, {rate, "encoding.levels=2", "encoding.log2_table_size=8", "occupancy.resolution=8",
                 "train.max_rays_per_batch=2", "march.steps_per_unit=8", "march.far_distance=3",
                 "train.checkpoint_every=50"});
    Trainer trainer(config, capture.scene, capture.data, run.path());
    std::string reason = "finished";
    try {
      EXPECT_TRUE(trainer.Run(never_stop).finished);
    } catch (const NonFiniteError& error) {
      reason = error.what();
      EXPECT_THAT(reason, testing::HasSubstr("step "));
      EXPECT_THAT(reason, testing::HasSubstr("stage "));
    }
    RecordProperty(rate, reason);
    const Checkpoint last = ReadRunCheckpoint(run.path());
    for (const auto& [name, tensor] : last.tensors) {
      EXPECT_TRUE(torch::isfinite(tensor).all().item<bool>()) << name << ", " << reason;
    }
    EXPECT_TRUE(std::isfinite(PsnrOver(ModelFromCheckpoint(last), capture.data.train))) << reason;
  }
}

// A NaN in a photograph in memory, which readers would have rejected.
TEST(HardScene, ANaNIsReportedWithStepRayAndStageAndTheLastCheckpointStays) {
  AnalyticCapture capture(CameraRing(8, 1.5, 0.8), 16, 16, StripedBall);
  const Config config =
      test::TinyConfig(400, {"train.checkpoint_every=1", "train.max_rays_per_batch=8"});
  capture.data.train[1].rgba[4 * 70] = std::numeric_limits<Eigen::half>::quiet_NaN();
  const test::ScratchFolder run;
  Trainer trainer(config, capture.scene, capture.data, run.path());
  std::string reason;
  try {
    trainer.Run(never_stop);
  } catch (const NonFiniteError& error) {
    reason = error.what();
  }
  EXPECT_THAT(reason, testing::AllOf(testing::HasSubstr("step "), testing::HasSubstr("ray "),
                                     testing::HasSubstr("target colours"),
                                     testing::HasSubstr("checkpoint stays")));
  const Model model = ModelFromCheckpoint(ReadRunCheckpoint(run.path()));
  EXPECT_TRUE(std::isfinite(PsnrOver(model, capture.held_out)));
}

}  // namespace
}  // namespace nerf
