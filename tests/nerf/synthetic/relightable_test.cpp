#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "nerf/image/image_io.h"
#include "nerf/synthetic/relightable_folder.h"
#include "nerf/synthetic/relightable_scene.h"
#include "sfm/transforms_json.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf::synthetic {
namespace {

namespace fs = std::filesystem;

TEST(RelightableScene, AMapInAFileLooksWhereTheWorldsDoes) {
  const BuiltInLight light = BuiltInLights().front();
  const EnvironmentMap world = MapInWorld(light, 64);
  const EnvironmentMap file(MapInFile(light, 64), "");
  for (const Eigen::Vector3d& d :
       {Eigen::Vector3d(0.8, 0.5, 0.45), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, -1, 0.1)}) {
    const Eigen::Vector3d in_world = d.normalized();
    const Eigen::Vector3d in_file(-in_world.y(), in_world.z(), -in_world.x());
    EXPECT_LT((world.Radiance(in_world) - file.Radiance(in_file)).abs().maxCoeff(), 0.8);
  }
  EXPECT_GT(world.Radiance(Eigen::Vector3d(0.8, 0.5, 0.45).normalized()).x(), 10);  // the sun
}

TEST(RelightableFolder, HasPhotographsLightsAndTruthThatFit) {
  const test::ScratchFolder scratch;
  const fs::path folder = scratch.path() / "still";
  RelightableOptions options;
  options.views = 3;
  options.test_views = 2;
  options.width = options.height = 48;
  options.paths = 8;
  options.lights = 2;
  ASSERT_TRUE(WriteRelightable(folder, options, [] { return true; }));
  const PosedImages posed = sfm::ReadTransformsJson(folder / "transforms_train.json");
  ASSERT_EQ(posed.images.size(), 5u);
  EXPECT_EQ(posed.images[0].light.name, "sunny");  // test/view_000
  EXPECT_EQ(posed.images[3].name, "train/view_001");
  EXPECT_EQ(posed.images[3].light.name, "lamps");
  const Image photo = ReadImage(folder / "test" / "view_000.png", false);
  const Image relit = ReadImage(folder / "test" / "view_000_overcast.png", false);
  const Image albedo = ReadImage(folder / "gt" / "view_000_albedo.exr", false);
  const Image normal = ReadImage(folder / "gt" / "view_000_normal.exr", false);
  const Image material = ReadImage(folder / "gt" / "view_000_material.exr", false);
  ASSERT_EQ(photo.channels, 4);
  int opaque = 0;
  for (std::size_t p = 0; p < photo.pixels.size() / 4; ++p) {
    EXPECT_NEAR(photo.pixels[4 * p + 3], albedo.pixels[4 * p + 3], 0.01f);
    EXPECT_NEAR(photo.pixels[4 * p + 3], relit.pixels[4 * p + 3], 0.01f);
    if (photo.pixels[4 * p + 3] < 0.999f) continue;
    ++opaque;
    EXPECT_NEAR(Eigen::Vector3f(&normal.pixels[3 * p]).norm(), 1, 1e-3f);
    EXPECT_GE(material.pixels[3 * p], 0.2f - 1e-3f);
    EXPECT_LE(material.pixels[3 * p], 0.9f + 1e-3f);
  }
  EXPECT_GT(opaque, 300);
  for (const char* light : {"sunny", "lamps", "overcast"}) {
    EXPECT_TRUE(fs::exists(folder / "environments" / (std::string(light) + ".exr")));
  }
  // It replaces its own captures, but nothing else.
  ASSERT_TRUE(WriteRelightable(folder, options, [] { return true; }));
  const fs::path other = scratch.path() / "other";
  fs::create_directories(other);
  std::ofstream(other / "letter.txt") << "mine";
  EXPECT_THAT(test::InputErrorOf([&] { WriteRelightable(other, options, [] { return true; }); }),
              testing::HasSubstr("is not a relightable capture"));
  options.lights = 4;
  EXPECT_THAT(test::InputErrorOf([&] { WriteRelightable(folder, options, [] { return true; }); }),
              testing::HasSubstr("--relightable is 4"));
}

}  // namespace
}  // namespace nerf::synthetic
