#include "sfm/colmap_model.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nerf/scene/camera_models.h"
#include "tests/support/colmap_model_folder.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;
using nerf::test::BinaryColmapFiles;
using nerf::test::ColmapContents;
using nerf::test::ColmapModel;
using nerf::test::InputErrorOf;
using nerf::test::SmallColmapContents;
using nerf::test::TextColmapFiles;
using testing::ElementsAre;
using testing::HasSubstr;

void ExpectSmallModel(const PosedImages& posed) {
  ASSERT_EQ(posed.images.size(), 3u);
  EXPECT_EQ(posed.images[0].name, "a b.ppm");
  EXPECT_EQ(posed.images[1].name, "c.ppm");
  EXPECT_EQ(posed.images[2].name, "sub/b.ppm");
  ASSERT_EQ(posed.cameras.size(), 2u);
  EXPECT_EQ(posed.cameras[posed.images[0].camera].model, CameraModel::kPinhole);
  EXPECT_EQ(posed.cameras[posed.images[1].camera].params, (std::vector<double>{10, 6, 4, 0.1}));
  EXPECT_EQ(posed.images[1].camera, posed.images[2].camera);
  EXPECT_TRUE(posed.missing.empty());
  // The file stores camera from world: x_in_camera = x_in_world + (0, 0, 4).
  EXPECT_TRUE(posed.images[0].world_from_camera.translation().isApprox(Eigen::Vector3d(0, 0, -4)));
  // A quarter turn about z, then (1, 2, 3).
  const Eigen::Vector3d x_in_camera =
      posed.images[1].world_from_camera.inverse() * Eigen::Vector3d(1, 0, 0);
  EXPECT_TRUE(x_in_camera.isApprox(Eigen::Vector3d(1, 3, 3), 1e-14));
  // A quaternion of length 2 is the rotation of one of length 1.
  EXPECT_TRUE(posed.images[2].world_from_camera.linear().isIdentity(1e-14));
  ASSERT_EQ(posed.points.size(), 2u);
  const SparsePoint& point = posed.points[0];
  EXPECT_EQ(point.x_in_world, Eigen::Vector3d(1, 2, 3));
  EXPECT_THAT(point.rgb, ElementsAre(10, 20, 30));
  EXPECT_EQ(point.reprojection_error, 0.5);
  ASSERT_EQ(point.track.size(), 3u);
  EXPECT_EQ(point.track[0].image, 1);
  EXPECT_EQ(point.track[0].pixel, Eigen::Vector2d(3, 4));
  EXPECT_EQ(point.track[1].image, 0);
  EXPECT_EQ(point.track[1].pixel, Eigen::Vector2d(0.25, 0.75));
  EXPECT_EQ(point.track[2].image, 2);
  EXPECT_EQ(point.track[2].pixel, Eigen::Vector2d(3, 2));
}

TEST_F(ColmapModel, BinaryAndTextAreReadAlike) {
  WriteImages();
  WriteFiles(TextColmapFiles(SmallColmapContents()), ".txt");
  ExpectSmallModel(Read());
  EXPECT_EQ(CountRegistered(Sparse()), 3);
  fs::remove_all(Sparse());
  WriteBinary(SmallColmapContents());
  ExpectSmallModel(Read());
  EXPECT_EQ(CountRegistered(Sparse()), 3);
  EXPECT_THAT(ColmapImageNames(Sparse()), ElementsAre("c.ppm", "a b.ppm", "sub/b.ppm"));
}

TEST_F(ColmapModel, BinaryIsPreferred) {
  WriteImages();
  WriteFiles({"nonsense", "nonsense", "nonsense"}, ".txt");
  WriteBinary(SmallColmapContents());
  ExpectSmallModel(Read());
}

TEST_F(ColmapModel, WindowsLineEndsAndImagesWithoutPointsAreRead) {
  WriteImages();
  WriteFiles({"3 SIMPLE_RADIAL 12 8 10 6 4 0.1\r\n",
              "21 1 0 0 0 0 0 0 3 c.ppm\r\n\r\n22 1 0 0 0 1 0 0 3 sub/b.ppm\n\n", ""},
             ".txt");
  const PosedImages posed = Read();
  ASSERT_EQ(posed.images.size(), 2u);
  EXPECT_EQ(posed.images[1].name, "sub/b.ppm");
}

TEST_F(ColmapModel, EveryCameraModelIsRead) {
  WriteImages();
  for (int id = 0; id < kNumCameraModels; ++id) {
    const CameraModel model = *CameraModelFromId(id);
    Camera camera{model, 12, 8, {}};
    for (int i = 0; i < CameraModelNumParams(model); ++i) camera.params.push_back(5 + 0.1 * i);
    ColmapContents contents;
    contents.cameras[1] = camera;
    contents.images = {{1, {1, 0, 0, 0}, {0, 0, 0}, 1, "c.ppm", {}}};
    for (const bool binary : {true, false}) {
      fs::remove_all(Sparse());
      WriteFiles(binary ? BinaryColmapFiles(contents) : TextColmapFiles(contents),
                 binary ? ".bin" : ".txt");
      EXPECT_THAT(Read().cameras, ElementsAre(camera)) << CameraModelName(model);
    }
  }
}

TEST_F(ColmapModel, MissingImagesAreNamedAndTheirObservationsDropped) {
  WriteImages();
  WriteBinary(SmallColmapContents());
  fs::remove(scratch_.path() / "images/a b.ppm");
  scratch_.Write("images/sub/b.ppm", "");
  const PosedImages posed = Read();
  ASSERT_EQ(posed.images.size(), 1u);
  EXPECT_THAT(posed.missing, ElementsAre("a b.ppm", "sub/b.ppm (not a readable image)"));
  EXPECT_EQ(posed.cameras.size(), 1u);
  ASSERT_EQ(posed.points[0].track.size(), 1u);
  EXPECT_EQ(posed.points[0].track[0].image, 0);
  EXPECT_EQ(posed.points[0].track[0].pixel, Eigen::Vector2d(3, 4));
  fs::remove_all(scratch_.path() / "images");
  EXPECT_THAT(ReadError(), HasSubstr("none of its 3 images"));
}

TEST_F(ColmapModel, PointsMayBeAbsentButCamerasNot) {
  WriteImages();
  WriteBinary(SmallColmapContents());
  fs::remove(Sparse() / "points3D.bin");
  EXPECT_EQ(Read().images.size(), 3u);
  EXPECT_TRUE(IsColmapModel(Sparse()));
  fs::remove(Sparse() / "cameras.bin");
  EXPECT_FALSE(IsColmapModel(Sparse()));
  EXPECT_THAT(ReadError(), HasSubstr("neither cameras.bin nor cameras.txt"));
}

TEST_F(ColmapModel, ExifRotatesOnlyImagesThatFitNoOtherWay) {
  const auto write_rotated = [&](const std::string& name, int width, int height) {
    const std::string file = (scratch_.path() / "images" / name).string();
    OIIO::ImageSpec spec(width, height, 1, OIIO::TypeUInt8);
    spec.attribute("Orientation", 6);
    const auto output = OIIO::ImageOutput::create("x.tif");
    ASSERT_TRUE(output && output->open(file, spec));
    const std::vector<unsigned char> pixels(static_cast<std::size_t>(width) * height);
    output->write_image(OIIO::TypeUInt8, pixels.data());
    output->close();
  };
  WriteImages();
  WriteBinary(SmallColmapContents());
  write_rotated("a b.ppm", 6, 5);
  write_rotated("c.ppm", 8, 12);
  const PosedImages posed = Read();
  EXPECT_FALSE(posed.images[0].upright_by_exif);
  EXPECT_TRUE(posed.images[1].upright_by_exif);
}

TEST_F(ColmapModel, LargestSubModelIsChosenWhateverItsNumber) {
  ColmapContents contents = SmallColmapContents();
  contents.points.clear();
  WriteBinary(contents, "sparse/10");
  contents.images.resize(1);
  WriteBinary(contents, "sparse/0");
  WriteFiles(TextColmapFiles(SmallColmapContents()), ".txt", "sparse/2");
  WriteBinary(SmallColmapContents(), "sparse/backup");
  fs::create_directory(Sparse() / "1");
  EXPECT_THAT(SubModels(Sparse()), ElementsAre(Sparse() / "0", Sparse() / "2", Sparse() / "10"));
  EXPECT_EQ(LargestModel(Sparse()), Sparse() / "2");
  EXPECT_THAT(InputErrorOf([&] { LargestModel(scratch_.path()); }),
              HasSubstr("contains no COLMAP model"));
}

TEST_F(ColmapModel, PhotographsMayBeReducedAndTracksFollow) {
  WriteImages();
  WriteBinary(SmallColmapContents());
  const PosedImages whole = Read();
  scratch_.WriteImage("images/c.ppm", 24, 16);
  const PosedImages posed = Read();
  const Camera &before = whole.cameras[whole.images[1].camera],
               &after = posed.cameras[posed.images[1].camera];
  EXPECT_EQ(after.width, 24);
  EXPECT_EQ(after.params[0], 2 * before.params[0]);
  // The other image of the same camera has its size still.
  EXPECT_EQ(posed.cameras[posed.images[2].camera], before);
  EXPECT_EQ(posed.points[0].track[0].pixel, 2 * whole.points[0].track[0].pixel);
  EXPECT_EQ(posed.points[0].track[2].pixel, whole.points[0].track[2].pixel);
}

TEST_F(ColmapModel, SightingsOfRemovedImagesAreDroppedWithAWarning) {
  WriteImages();
  ColmapContents contents = SmallColmapContents();
  contents.points[1].track[0].first = 1;  // no image has this id
  WriteBinary(contents);
  const PosedImages posed = Read();
  EXPECT_EQ(posed.points[1].track.size(), contents.points[1].track.size() - 1);
  EXPECT_THAT(posed.warnings, ElementsAre(HasSubstr("1 sightings are of images that are not in")));
}

TEST_F(ColmapModel, NamesMayDifferInCase) {
  WriteImages();
  fs::rename(scratch_.path() / "images/c.ppm", scratch_.path() / "images/C.PPM");
  WriteBinary(SmallColmapContents());
  const PosedImages posed = Read();
  EXPECT_EQ(posed.images[1].name, "c.ppm");
  EXPECT_EQ(posed.images[1].path.filename(), "C.PPM");
}

}  // namespace
}  // namespace nerf::sfm
