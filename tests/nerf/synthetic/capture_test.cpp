#include "nerf/synthetic/capture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "nerf/image/srgb.h"
#include "nerf/scene/camera.h"
#include "nerf/synthetic/ray_tracer.h"

namespace nerf::synthetic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

SampleOptions Small() {
  SampleOptions options;
  options.views = 6;
  options.width = 32;
  options.height = 24;
  options.samples_per_pixel = 3;
  return options;
}

// Rendered once for all tests that do not change it.
const Capture& SmallCapture() {
  static const Capture capture = MakeCapture(Small());
  return capture;
}

Vector3d Load(const Image& image, int x, int y) {
  const float* p = image.At(x, y);
  return {p[0], p[1], p[2]};
}

TEST(Capture, IsIndependentOfTheNumberOfThreads) {
  SampleOptions options = Small();
  options.threads = 1;
  const Capture one = MakeCapture(options);
  options.threads = 3;
  const Capture three = MakeCapture(options);
  ASSERT_EQ(one.views.size(), three.views.size());
  for (std::size_t i = 0; i < one.views.size(); ++i) {
    EXPECT_EQ(one.views[i].photo.pixels, three.views[i].photo.pixels);
    EXPECT_EQ(one.views[i].depth.pixels, three.views[i].depth.pixels);
  }
}

TEST(Capture, HasAViewForEachPose) {
  const Capture& capture = SmallCapture();
  ASSERT_EQ(capture.views.size(), capture.posed.images.size());
  for (const View& view : capture.views) {
    EXPECT_EQ(view.photo.width, 32);
    EXPECT_EQ(view.photo.height, 24);
    EXPECT_EQ(view.photo.encoding, ColorEncoding::kSrgb);
    EXPECT_EQ(view.depth.channels, 1);
    EXPECT_EQ(view.normal.channels, 3);
    EXPECT_EQ(view.albedo.encoding, ColorEncoding::kLinear);
  }
}

TEST(Capture, HasValuesInRange) {
  for (const View& view : SmallCapture().views) {
    for (const Image* image : {&view.photo, &view.albedo}) {
      for (const float value : image->pixels) {
        ASSERT_GE(value, 0);
        ASSERT_LE(value, 1);
      }
    }
    for (int y = 0; y < view.normal.height; ++y) {
      for (int x = 0; x < view.normal.width; ++x) {
        ASSERT_NEAR(Load(view.normal, x, y).norm(), 1, 1e-5);
        ASSERT_GT(*view.depth.At(x, y), 1);
        ASSERT_LT(*view.depth.At(x, y), 12);
      }
    }
  }
}

TEST(Capture, NormalsFaceTheCamera) {
  const Capture& capture = SmallCapture();
  const auto& pose = capture.posed.images[0].world_from_camera;
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 32; ++x) {
      const Vector3d ray = *DirectionFromPixel(capture.posed.cameras[0], {x + 0.5, y + 0.5});
      EXPECT_LE((pose.linear() * ray).dot(Load(capture.views[0].normal, x, y)), 1e-5);
    }
  }
}

// A point from the depth and pose of view A, projected into view B, must be at the depth of B
// there, or behind it.
TEST(Capture, DepthsOfDifferentViewsAgree) {
  SampleOptions options = Small();
  options.width = 80;
  options.height = 60;
  options.samples_per_pixel = 1;
  const Capture capture = MakeCapture(options);
  const Camera& camera = capture.posed.cameras[0];
  int seen = 0;
  int agreed = 0;
  for (std::size_t a = 0; a < capture.views.size(); ++a) {
    const std::size_t b = (a + 1) % capture.views.size();
    const auto& world_from_a = capture.posed.images[a].world_from_camera;
    const auto b_from_world = capture.posed.images[b].world_from_camera.inverse();
    for (int y = 0; y < options.height; y += 2) {
      for (int x = 0; x < options.width; x += 2) {
        const Vector3d ray = *DirectionFromPixel(camera, {x + 0.5, y + 0.5});
        const Vector3d x_in_world = world_from_a * (ray * *capture.views[a].depth.At(x, y));
        const Vector3d x_in_b = b_from_world * x_in_world;
        const auto pixel = PixelFromPoint(camera, x_in_b);
        if (!pixel) continue;
        const int u = static_cast<int>(std::floor(pixel->x()));
        const int v = static_cast<int>(std::floor(pixel->y()));
        if (u < 1 || v < 1 || u >= options.width - 1 || v >= options.height - 1) continue;
        // The range of depths of B within a pixel of the projection.
        const double footprint = x_in_b.norm() / FocalLength(camera);
        float nearest = 1e9f, farthest = 0;
        for (int dv = -1; dv <= 1; ++dv) {
          for (int du = -1; du <= 1; ++du) {
            nearest = std::min(nearest, *capture.views[b].depth.At(u + du, v + dv));
            farthest = std::max(farthest, *capture.views[b].depth.At(u + du, v + dv));
          }
        }
        ++seen;
        ASSERT_GE(x_in_b.norm(), nearest - footprint)
            << "the point of A is in front of the surface seen by B";
        agreed += x_in_b.norm() <= farthest + 1e-3;
      }
    }
  }
  EXPECT_GT(seen, 2000);
  EXPECT_GT(agreed, 0.6 * seen);  // the rest is hidden from B
}

TEST(Capture, PixelCentersAreAtHalves) {
  const Capture& capture = SmallCapture();
  const Scene scene = BuiltInScene();
  const auto& pose = capture.posed.images[2].world_from_camera;
  const Vector3d ray = *DirectionFromPixel(capture.posed.cameras[0], {17.5, 20.5});
  const auto hit = Trace(scene, {pose.translation(), pose.linear() * ray});
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(*capture.views[2].depth.At(17, 20), hit->distance, 1e-5);
}

TEST(RenderView, AveragesRadianceInLinearLightOverThePixel) {
  // One pixel sees the edge of a box: white on the left half, black on the right.
  Scene scene;
  scene.objects = {{Box{{-1, 0, -1}, {1, 5, 1}}, {.albedo = Plain{Color::Ones()}}}};
  scene.ambient = {Color::Ones(), Color::Ones()};
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
  world_from_camera.linear() = Vector3d(1, -1, -1).asDiagonal();  // looks down
  world_from_camera.translation() = Vector3d(0, 0, 100);
  const Camera camera = PinholeFromFov(1, 1, 0.01);
  const View view = RenderView(scene, camera, world_from_camera, 400, 1);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(LinearFromSrgb(view.photo.pixels[c]), 0.5, 0.01);
}

TEST(RenderViews, PassesOnExceptionsOfTheConsumer) {
  const Capture& capture = SmallCapture();
  EXPECT_THROW(RenderViews(BuiltInScene(), capture.posed, Small(),
                           [](int, const View&) { throw std::runtime_error("full"); }),
               std::runtime_error);
}

}  // namespace
}  // namespace nerf::synthetic
