#include "sfm/colmap_text_writer.h"

#include <gtest/gtest.h>

#include "nerf/synthetic/sample_folder.h"
#include "sfm/colmap_model.h"
#include "sfm/transforms_json.h"
#include "tests/support/scratch_folder.h"

namespace nerf::sfm {
namespace {

TEST(ColmapText, IsReadBack) {
  const nerf::test::ScratchFolder folder;
  nerf::synthetic::SampleOptions options;
  options.views = 6;
  options.width = 32;
  options.height = 24;
  options.samples_per_pixel = 1;
  nerf::synthetic::WriteSample(folder.path(), options);
  const PosedImages posed =
      ReadColmapModel(folder.path() / "truth" / "sparse", folder.path() / "images");
  ASSERT_GT(posed.points.size(), 100u);

  const auto again = folder.path() / "again";
  std::filesystem::create_directories(again);
  WriteColmapText(posed, again);
  const PosedImages back = ReadColmapModel(again, folder.path() / "images");
  EXPECT_EQ(back.cameras, posed.cameras);
  ASSERT_EQ(back.images.size(), posed.images.size());
  for (std::size_t i = 0; i < back.images.size(); ++i) {
    EXPECT_EQ(back.images[i].name, posed.images[i].name);
    EXPECT_TRUE(
        back.images[i].world_from_camera.isApprox(posed.images[i].world_from_camera, 1e-12));
  }
  ASSERT_EQ(back.points.size(), posed.points.size());
  for (std::size_t p = 0; p < back.points.size(); ++p) {
    EXPECT_EQ(back.points[p].x_in_world, posed.points[p].x_in_world);
    ASSERT_EQ(back.points[p].track.size(), posed.points[p].track.size());
    for (std::size_t k = 0; k < back.points[p].track.size(); ++k) {
      EXPECT_EQ(back.points[p].track[k].image, posed.points[p].track[k].image);
      EXPECT_EQ(back.points[p].track[k].pixel, posed.points[p].track[k].pixel);
    }
  }
  // And the poses are those of the transforms.json beside it.
  const PosedImages json = ReadTransformsJson(folder.path() / "truth" / "transforms.json");
  for (std::size_t i = 0; i < json.images.size(); ++i) {
    EXPECT_TRUE(json.images[i].world_from_camera.isApprox(posed.images[i].world_from_camera, 1e-9));
  }
}

}  // namespace
}  // namespace nerf::sfm
