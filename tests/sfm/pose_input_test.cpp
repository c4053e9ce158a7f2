#include "sfm/pose_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/colmap_files.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;
using nerf::test::InputErrorOf;
using testing::HasSubstr;

class PoseInput : public testing::Test {
 protected:
  void WriteModel(const std::string& folder, std::size_t images = 3) {
    nerf::test::ColmapContents contents = nerf::test::SmallColmapContents();
    contents.images.resize(images);
    contents.points.clear();
    const nerf::test::ColmapFiles files = nerf::test::BinaryColmapFiles(contents);
    scratch_.Write(folder + "/cameras.bin", files.cameras);
    scratch_.Write(folder + "/images.bin", files.images);
    scratch_.Write(folder + "/points3D.bin", files.points);
  }
  void WritePhotos(const std::string& folder) {
    scratch_.WriteImage(folder + "/a b.ppm", 6, 5);
    scratch_.WriteImage(folder + "/c.ppm", 12, 8);
    scratch_.WriteImage(folder + "/sub/b.ppm", 12, 8);
  }
  void ExpectFound(const fs::path& input, InputKind kind, const fs::path& model,
                   const fs::path& images) {
    const InputLocation location = FindInput(scratch_.path() / input);
    EXPECT_EQ(location.kind, kind);
    EXPECT_EQ(location.model, model.empty() ? model : scratch_.path() / model);
    EXPECT_TRUE(fs::equivalent(location.images, scratch_.path() / images)) << location.images;
  }
  std::string FindError(const fs::path& input) {
    return InputErrorOf([&] { FindInput(scratch_.path() / input); });
  }
  nerf::test::ScratchFolder scratch_;
};

TEST_F(PoseInput, PosesAreFoundBeforeColmapModelsBeforePhotos) {
  WritePhotos("p/images");
  ExpectFound("p", InputKind::kPhotos, "", "p/images");
  scratch_.WriteImage("p/top.JPG", 4, 4);
  ExpectFound("p", InputKind::kPhotos, "", "p");
  WriteModel("p/colmap/sparse/0");
  ExpectFound("p", InputKind::kColmap, "p/colmap/sparse/0", "p/images");
  scratch_.Write("p/poses_bounds.npy", "");
  ExpectFound("p", InputKind::kLlff, "p/poses_bounds.npy", "p/images");
  scratch_.Write("p/transforms_train.json", "");
  ExpectFound("p", InputKind::kTransforms, "p/transforms_train.json", "p");
  scratch_.Write("p/transforms.json", "");
  ExpectFound("p", InputKind::kTransforms, "p/transforms.json", "p");
  ExpectFound("p/transforms_train.json", InputKind::kTransforms, "p/transforms_train.json", "p");
  ExpectFound("p/poses_bounds.npy", InputKind::kLlff, "p/poses_bounds.npy", "p/images");
}

TEST_F(PoseInput, LargestSubModelIsTaken) {
  WritePhotos("p/images");
  WriteModel("p/sparse/0", 1);
  WriteModel("p/sparse/1", 3);
  ExpectFound("p", InputKind::kColmap, "p/sparse/1", "p/images");
  ExpectFound("p/sparse", InputKind::kColmap, "p/sparse/1", "p/images");
  ExpectFound("p/sparse/0", InputKind::kColmap, "p/sparse/0", "p/images");
  ExpectFound("p/sparse/0/", InputKind::kColmap, "p/sparse/0/", "p/images");
  EXPECT_EQ(ReadPosedInput(FindInput(scratch_.path() / "p")).images.size(), 3u);
}

TEST_F(PoseInput, PhotographsOfAModelAreInTheFolderWithMostOfItsNames) {
  WriteModel("p/sparse");
  WritePhotos("p");
  scratch_.WriteImage("p/images/c.ppm", 12, 8);
  ExpectFound("p", InputKind::kColmap, "p/sparse", "p");
  WriteModel("q");
  EXPECT_THAT(FindError("q"), HasSubstr("none of the 3 images of this COLMAP model was found"));
  WritePhotos("images");
  ExpectFound("q", InputKind::kColmap, "q", "images");
}

TEST_F(PoseInput, InvalidInputsAreExplained) {
  EXPECT_THAT(FindError("absent"), HasSubstr("absent: no such file or folder"));
  scratch_.Write("notes.txt", "x");
  EXPECT_THAT(FindError("notes.txt"), HasSubstr("not an input"));
  EXPECT_THAT(FindError(""), HasSubstr("neither transforms.json"));
  EXPECT_THAT(InputErrorOf([&] {
                ReadPosedInput({InputKind::kPhotos, {}, "photos"});
              }),
              HasSubstr("photos: photographs without poses"));
}

TEST_F(PoseInput, RelativeInputsAreFound) {
  WritePhotos("p/images");
  WriteModel("p/sparse/0");
  const fs::path before = fs::current_path();
  fs::current_path(scratch_.path() / "p/sparse/0");
  const InputLocation location = FindInput(".");
  EXPECT_EQ(ReadPosedInput(location).images.size(), 3u);
  fs::current_path(before);
}

TEST_F(PoseInput, FoxIsATransformsJson) {
  const InputLocation location = FindInput(NERF_TEST_DATA "/fox");
  EXPECT_EQ(location.kind, InputKind::kTransforms);
  EXPECT_EQ(FindInput(NERF_TEST_DATA "/fox/images").kind, InputKind::kPhotos);
}

TEST_F(PoseInput, ReducedPhotographsOfAModelAreFound) {
  WriteModel("p/sparse/0");
  WritePhotos("p/images_4");
  ExpectFound("p", InputKind::kColmap, "p/sparse/0", "p/images_4");
  ExpectFound("p/sparse/0", InputKind::kColmap, "p/sparse/0", "p/images_4");
  WritePhotos("p/images");
  ExpectFound("p", InputKind::kColmap, "p/sparse/0", "p/images");
}

TEST_F(PoseInput, AFilmIsAnInput) {
  scratch_.Write("p/clip.MOV", "x");
  ExpectFound("p/clip.MOV", InputKind::kFilm, "", "p/clip.MOV");
  ExpectFound("p", InputKind::kFilm, "", "p/clip.MOV");
  scratch_.WriteImage("p/thumbnail.jpg", 6, 5);
  ExpectFound("p", InputKind::kFilm, "", "p/clip.MOV");
  fs::remove(scratch_.path() / "p/thumbnail.jpg");
  scratch_.Write("p/clip2.mp4", "x");
  EXPECT_THAT(FindError("p"), HasSubstr("contains 2 films; give one of them"));
  WritePhotos("p");
  ExpectFound("p", InputKind::kPhotos, "", "p");
  scratch_.Write("photos.zip", "x");
  EXPECT_THAT(FindError("photos.zip"), HasSubstr("give a folder of photographs, a film"));
}

TEST_F(PoseInput, PhotographsMayBeInSubFolders) {
  scratch_.WriteImage("p/left/1.jpg", 6, 5);
  scratch_.WriteImage("p/right/1.jpg", 6, 5);
  ExpectFound("p", InputKind::kPhotos, "", "p");
  scratch_.WriteImage("q/images/left/1.jpg", 6, 5);
  ExpectFound("q", InputKind::kPhotos, "", "q/images");
  scratch_.WriteImage("r/masks/1.jpg", 6, 5);
  EXPECT_THAT(FindError("r"), HasSubstr("contains no photographs"));
}

}  // namespace
}  // namespace nerf::sfm
