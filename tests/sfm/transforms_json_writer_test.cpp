#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "nerf/scene/camera_intrinsics.h"
#include "nerf/scene/camera_models.h"
#include "sfm/transforms_json.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;
using nerf::test::InputErrorOf;
using nerf::test::ScratchFolder;
using nlohmann::json;
using testing::HasSubstr;

// Images with poses of full precision in every split, one of each camera.
PosedImages PosedWith(const std::vector<Camera>& cameras, const ScratchFolder& scratch) {
  PosedImages posed;
  posed.cameras = cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    PosedImage image;
    image.name = fmt::format("photos/{:02}.ppm", i);
    image.path = scratch.WriteImage(image.name, cameras[i].width, cameras[i].height);
    image.camera = static_cast<int>(i);
    const Eigen::AngleAxisd turn(0.1 + 0.2 * static_cast<double>(i),
                                 Eigen::Vector3d(1, 2, 3).normalized());
    image.world_from_camera = Eigen::Translation3d(1. / 3, 1e6 / 7, -1e-7) * turn;
    image.split = static_cast<Split>(i % 4);
    posed.images.push_back(image);
  }
  return posed;
}

TEST(TransformsJsonWriter, EveryCameraModelSplitAndPoseIsRestored) {
  const ScratchFolder scratch;
  std::vector<Camera> cameras;
  for (int id = 0; id < kNumCameraModels; ++id) {
    Camera camera{static_cast<CameraModel>(id), 20 + id, 10, {}};
    for (int i = 0; i < CameraModelNumParams(camera.model); ++i) {
      camera.params.push_back((i < 3 ? 10. : 0.1) / (3 + i));
    }
    cameras.push_back(camera);
  }
  const PosedImages posed = PosedWith(cameras, scratch);
  const fs::path file = scratch.path() / "out/transforms.json";
  fs::create_directory(file.parent_path());
  WriteTransformsJson(posed, file);
  const PosedImages back = ReadTransformsJson(file);
  ASSERT_EQ(back.images.size(), posed.images.size());
  for (std::size_t i = 0; i < back.images.size(); ++i) {
    EXPECT_EQ(back.images[i].name, posed.images[i].name) << "whatever folder the file lies in";
    EXPECT_TRUE(fs::equivalent(back.images[i].path, posed.images[i].path));
    EXPECT_EQ(back.images[i].split, posed.images[i].split);
    EXPECT_TRUE(back.images[i].world_from_camera.linear().isApprox(
        posed.images[i].world_from_camera.linear(), 1e-14));
    EXPECT_EQ(back.images[i].world_from_camera.translation(),
              posed.images[i].world_from_camera.translation());
    const Camera& before = cameras[i];
    const Camera& after = back.cameras[back.images[i].camera];
    EXPECT_EQ(FocalLengths(after), FocalLengths(before));
    EXPECT_EQ(PrincipalPoint(after), PrincipalPoint(before));
    EXPECT_EQ(after.width, before.width);
    // The models share the order of their common parameters; the larger model ends in zeros.
    std::vector<double> distortion(before.params.begin() + FirstDistortionParam(before.model),
                                   before.params.end());
    const int first = FirstDistortionParam(after.model);
    distortion.resize(after.params.size() - first);
    EXPECT_EQ(std::vector<double>(after.params.begin() + first, after.params.end()), distortion);
  }
  const auto model = [&](CameraModel before) {
    return back.cameras[back.images[static_cast<int>(before)].camera].model;
  };
  EXPECT_EQ(model(CameraModel::kSimplePinhole), CameraModel::kPinhole);
  EXPECT_EQ(model(CameraModel::kRadial), CameraModel::kOpenCV);
  EXPECT_EQ(model(CameraModel::kRadialFisheye), CameraModel::kOpenCVFisheye);
  for (const CameraModel same :
       {CameraModel::kPinhole, CameraModel::kOpenCV, CameraModel::kOpenCVFisheye,
        CameraModel::kFullOpenCV, CameraModel::kFov, CameraModel::kThinPrismFisheye}) {
    EXPECT_EQ(model(same), same);
  }
}

TEST(TransformsJsonWriter, OneCameraIsWrittenOnceAndPathsAreRelative) {
  const ScratchFolder scratch;
  const Camera camera{CameraModel::kFullOpenCV, 20, 10, {9, 8, 7, 6, .1, .2, .3, .4, .5, .6, 0, 0}};
  PosedImages posed = PosedWith({camera}, scratch);
  const fs::path file = scratch.path() / "transforms.json";
  WriteTransformsJson(posed, file);
  const json root = json::parse(std::ifstream(file));
  EXPECT_EQ(root["camera_model"], "OPENCV");
  EXPECT_EQ(root["k4"], 0.6);
  EXPECT_EQ(root["frames"][0]["file_path"], "photos/00.ppm");
  EXPECT_FALSE(root["frames"][0].contains("fl_x"));
  EXPECT_FALSE(root.contains("train_filenames"));
  EXPECT_EQ(ReadTransformsJson(file).cameras, posed.cameras);
}

// The size of a square photograph, or of one rotated by 180 degrees, does not show the rotation.
TEST(TransformsJsonWriter, APhotographRotatedByExifStaysRotated) {
  const ScratchFolder scratch;
  PosedImages posed = PosedWith({{CameraModel::kPinhole, 8, 8, {9, 9, 4, 4}}}, scratch);
  for (const bool upright_by_exif : {true, false}) {
    posed.images[0].upright_by_exif = upright_by_exif;
    WriteTransformsJson(posed, scratch.path() / "transforms.json");
    EXPECT_EQ(ReadTransformsJson(scratch.path() / "transforms.json").images[0].upright_by_exif,
              upright_by_exif);
  }
}

TEST(TransformsJsonWriter, UnwritableFolderIsNamedAndNoFileIsLeft) {
  const ScratchFolder scratch;
  const PosedImages posed = PosedWith({{CameraModel::kSimplePinhole, 4, 4, {1, 2, 2}}}, scratch);
  const fs::path file = scratch.path() / "absent/transforms.json";
  EXPECT_THAT(InputErrorOf([&] { WriteTransformsJson(posed, file); }),
              HasSubstr("absent/transforms.json: cannot be written"));
  fs::create_directories(scratch.path() / "taken.json");
  EXPECT_THAT(InputErrorOf([&] { WriteTransformsJson(posed, scratch.path() / "taken.json"); }),
              HasSubstr("taken.json: cannot be written"));
  for (const auto& entry : fs::directory_iterator(scratch.path())) {
    EXPECT_EQ(entry.path().string().find(".tmp"), std::string::npos) << entry.path();
  }
}

}  // namespace
}  // namespace nerf::sfm
