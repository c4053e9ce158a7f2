#include "sfm/transforms_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/transforms_json_file.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;
using nerf::test::Frame;
using nerf::test::InputErrorOf;
using nerf::test::ScratchFolder;
using nerf::test::TransformsJson;
using nerf::test::TwoFrames;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(TransformsJson, FramesAreSortedAndShareOneCamera) {
  json root = TwoFrames();
  root["aabb_scale"] = 16;
  root["frames"][0]["transform_matrix"][0][3] = 7;
  const PosedImages posed = Read(root);
  ASSERT_EQ(posed.images.size(), 2u);
  EXPECT_EQ(posed.images[0].name, "images/a.ppm");
  EXPECT_EQ(posed.images[1].name, "images/b.ppm");
  EXPECT_EQ(posed.images[1].split, Split::kUnspecified);
  EXPECT_TRUE(fs::equivalent(posed.images[0].path, scratch_.path() / "images/a.ppm"));
  EXPECT_EQ(posed.source, scratch_.path() / "transforms.json");
  // The camera of the file looks along -z with y up.
  EXPECT_EQ(posed.images[1].world_from_camera * Eigen::Vector3d(0, 1, 2),
            Eigen::Vector3d(7, -1, -2));
  EXPECT_THAT(posed.cameras, ElementsAre(Camera{CameraModel::kPinhole, 20, 10, {30, 31, 10, 5}}));
}

TEST_F(TransformsJson, ModelIsTheSimplestThatIsEquivalent) {
  const std::vector<double> pinhole = {30, 31, 9, 4};
  const auto with = [&](std::vector<double> more) {
    more.insert(more.begin(), pinhole.begin(), pinhole.end());
    return more;
  };
  const auto expect = [&](json keys, CameraModel model, const std::vector<double>& params) {
    keys.update({{"cx", 9}, {"cy", 4}});
    EXPECT_EQ(ReadCamera(keys), (Camera{model, 20, 10, params})) << keys;
  };
  expect({{"k1", 0}, {"k3", 0}, {"camera_model", "OPENCV"}}, CameraModel::kPinhole, pinhole);
  expect({{"k1", 0.1}, {"p2", 0.2}, {"k3", 0}}, CameraModel::kOpenCV, with({0.1, 0, 0, 0.2}));
  expect({{"k1", 0.1}, {"k3", 0.3}, {"is_fisheye", false}}, CameraModel::kFullOpenCV,
         with({0.1, 0, 0, 0, 0.3, 0, 0, 0}));
  expect({{"k1", 0.1}, {"k4", 0.4}, {"is_fisheye", true}}, CameraModel::kOpenCVFisheye,
         with({0.1, 0, 0, 0.4}));
  expect({{"camera_model", "OPENCV_FISHEYE"}}, CameraModel::kOpenCVFisheye, with({0, 0, 0, 0}));
  expect({{"camera_model", "SIMPLE_RADIAL"}, {"k1", 0.1}}, CameraModel::kOpenCV,
         with({0.1, 0, 0, 0}));
  expect({{"camera_model", "FOV"}, {"camera_params", {30, 31, 9, 4, 0.9}}}, CameraModel::kFov,
         with({0.9}));
}

TEST_F(TransformsJson, FieldsOfViewGiveTheFocalLength) {
  json root = TwoFrames();
  for (const char* key : {"fl_x", "fl_y", "w", "h"}) root.erase(key);
  root["camera_angle_x"] = 2 * std::atan(0.5);
  EXPECT_NEAR(Read(root).cameras[0].params[0], 20, 1e-12);
  EXPECT_NEAR(Read(root).cameras[0].params[1], 20, 1e-12);
  root["camera_angle_y"] = 2 * std::atan(0.5);
  EXPECT_NEAR(Read(root).cameras[0].params[1], 10, 1e-12);
  root["x_fov"] = 90;
  EXPECT_NEAR(Read(root).cameras[0].params[0], 10, 1e-12);
}

TEST_F(TransformsJson, FrameOverridesTheFile) {
  json root = TwoFrames();
  root["k1"] = 0.1;
  root["frames"][0].update({{"fl_x", 40}, {"k1", 0}});
  const PosedImages posed = Read(root);
  ASSERT_EQ(posed.cameras.size(), 2u);
  EXPECT_EQ(posed.cameras[posed.images[0].camera].params,
            (std::vector<double>{30, 31, 10, 5, 0.1, 0, 0, 0}));
  // One focal length in a frame means both.
  EXPECT_EQ(posed.cameras[posed.images[1].camera].params, (std::vector<double>{40, 40, 10, 5}));
}

TEST_F(TransformsJson, LensIsScaledToReducedImages) {
  EXPECT_EQ(ReadCamera({{"w", 40}, {"h", 20}, {"cx", 22}}),
            (Camera{CameraModel::kPinhole, 20, 10, {15, 15.5, 11, 5}}));
  json root = TwoFrames();
  root["w"] = 50;
  const std::string error = ReadError(root);
  EXPECT_THAT(error, HasSubstr("transforms.json: frames[0].file_path"));
  EXPECT_THAT(error, HasSubstr("is 20x10 pixels"));
  EXPECT_THAT(error, HasSubstr("50x10"));
}

TEST_F(TransformsJson, MissingImagesAreCountedAndNamed) {
  json root = TwoFrames();
  root["frames"].push_back(Frame("images/lost.ppm"));
  scratch_.Write("images/b.ppm", "");
  const PosedImages posed = Read(root);
  EXPECT_THAT(posed.missing, ElementsAre("images/b.ppm (not a readable image)", "images/lost.ppm"));
  EXPECT_EQ(posed.images.size(), 1u);
  fs::remove_all(scratch_.path() / "images");
  EXPECT_THAT(ReadError(root), HasSubstr("none of its 3 images was found"));
}

TEST_F(TransformsJson, NerfstudioListsMarkSplitsAndTrainingHasPrecedence) {
  json root = TwoFrames();
  root["train_filenames"] = {"./images/a.ppm"};
  root["val_filenames"] = {"images/a.ppm", "images/b.ppm"};
  PosedImages posed = Read(root);
  EXPECT_EQ(posed.images[0].split, Split::kTrain);
  EXPECT_EQ(posed.images[1].split, Split::kValidation);
  root["test_filenames"] = {"images/b.ppm"};
  posed = Read(root);
  EXPECT_EQ(posed.images[1].split, Split::kTest);
  root["test_filenames"] = {"images/c.ppm"};
  EXPECT_THAT(ReadError(root),
              HasSubstr("test_filenames: no frame has the file_path 'images/c.ppm'"));
  root["test_filenames"] = 3;
  EXPECT_THAT(ReadError(root), HasSubstr("test_filenames must be a list"));
}

TEST_F(TransformsJson, BlenderFilesOfTheOtherSplitsAreReadToo) {
  for (const char* name : {"train/r_0.png", "val/r_0.png", "test/r_0.png"}) {
    scratch_.WriteImage(name, 8, 8);
  }
  const auto write = [&](const std::string& split, const json& frames) {
    const json root = {{"camera_angle_x", 0.7}, {"frames", frames}};
    return scratch_.Write("transforms_" + split + ".json", root.dump());
  };
  const fs::path train = write("train", json::array({Frame("./train/r_0")}));
  write("val", json::array({Frame("./val/r_0")}));
  // A training image in the test file stays a training image.
  const fs::path test = write("test", {Frame("./test/r_0"), Frame("./train/r_0")});
  const PosedImages posed = ReadTransformsJson(train);
  ASSERT_EQ(posed.images.size(), 3u);
  EXPECT_EQ(posed.images[0].name, "test/r_0");
  EXPECT_EQ(posed.images[0].split, Split::kTest);
  EXPECT_EQ(posed.images[1].name, "train/r_0");
  EXPECT_EQ(posed.images[1].split, Split::kTrain);
  EXPECT_EQ(posed.images[2].split, Split::kValidation);
  EXPECT_EQ(posed.images[2].path.filename(), "r_0.png");
  EXPECT_EQ(posed.cameras.size(), 1u);
  EXPECT_EQ(ReadTransformsJson(test).images.size(), 2u);
  scratch_.Write("transforms_val.json", "{");
  EXPECT_THAT(InputErrorOf([&] { ReadTransformsJson(train); }), HasSubstr("transforms_val.json"));
}

TEST_F(TransformsJson, FoxHasFiftyOfItsImages) {
  const PosedImages posed = ReadTransformsJson(NERF_TEST_DATA "/fox/transforms.json");
  EXPECT_EQ(posed.images.size(), 50u);
  EXPECT_EQ(posed.missing.size(), 17u);
  ASSERT_EQ(posed.cameras.size(), 1u);
  EXPECT_EQ(posed.cameras[0].model, CameraModel::kOpenCV);
  EXPECT_EQ(posed.cameras[0].params[0], 1375.52);
  EXPECT_EQ(posed.images[0].name, "images/0001.jpg");
  EXPECT_FALSE(posed.images[0].upright_by_exif);
  // -z of the third column of the file.
  EXPECT_TRUE(posed.images[0].world_from_camera.linear().col(2).isApprox(
      Eigen::Vector3d(-0.44209, 0.894069, 0.0720918), 1e-5));
}

TEST_F(TransformsJson, ChairIncludesItsTestViews) {
  const PosedImages posed = ReadTransformsJson(NERF_TEST_DATA "/chair/transforms_train.json");
  const auto count = [&](Split split) {
    return std::count_if(posed.images.begin(), posed.images.end(),
                         [&](const PosedImage& image) { return image.split == split; });
  };
  EXPECT_EQ(count(Split::kTrain), 100);
  EXPECT_EQ(count(Split::kTest), 25);
  EXPECT_TRUE(posed.missing.empty());
  ASSERT_EQ(posed.cameras.size(), 1u);
  EXPECT_NEAR(posed.cameras[0].params[0], 555.5555, 1e-3);
}

TEST_F(TransformsJson, InvalidFramesAreRefusedByIndexAndKey) {
  const auto error_with = [&](const std::string& pointer, const json& value) {
    json root = TwoFrames();
    root[json::json_pointer(pointer)] = value;
    return ReadError(root);
  };
  const std::string matrix = "/frames/1/transform_matrix";
  const std::string in_matrix = "transforms.json: frames[1].transform_matrix";
  EXPECT_THAT(error_with(matrix + "/0/0", 2), HasSubstr(in_matrix + ": not a rigid motion"));
  EXPECT_THAT(error_with(matrix + "/3/0", 1), HasSubstr(in_matrix + ": the last row"));
  EXPECT_THAT(error_with(matrix + "/2/1", "x"), HasSubstr(in_matrix + "[2][1] must be a finite"));
  EXPECT_THAT(error_with(matrix + "/2", {1, 2}), HasSubstr(in_matrix + " must be 4 lists of 4"));
  EXPECT_THAT(error_with(matrix, json::array()), HasSubstr(in_matrix + " must be 4 lists of 4"));
  EXPECT_THAT(error_with(matrix, 1), HasSubstr(in_matrix + " must be a list"));
  EXPECT_THAT(error_with("/frames/1", json::object()), HasSubstr("frames[1].file_path is missing"));
  EXPECT_THAT(error_with("/frames/1", 5), HasSubstr("frames[1]: must be an object"));
  EXPECT_THAT(error_with("/frames/1/file_path", 5), HasSubstr("frames[1].file_path must be a str"));
  EXPECT_THAT(error_with("/frames/1/file_path", "images/b.ppm"),
              HasSubstr("is also that of frames[0]"));
  EXPECT_THAT(error_with("/frames/1/fl_x", "wide"), HasSubstr("frames[1].fl_x must be a finite"));
  EXPECT_THAT(error_with("/frames/1/fl_x", -3), HasSubstr("frames[1].fl_x must be positive"));
  EXPECT_THAT(error_with("/frames", json::array()), HasSubstr("frames is missing or empty"));
  EXPECT_THAT(error_with("/frames", 1), HasSubstr("frames must be a list"));
  EXPECT_THAT(error_with("/w", 0), HasSubstr("transforms.json: w must be a whole number"));
  EXPECT_THAT(error_with("/h", 1e300), HasSubstr("transforms.json: h must be a whole number"));
  EXPECT_THAT(error_with("/w", 10.5), HasSubstr("w must be a whole number"));
  EXPECT_THAT(ReadError(std::string(R"({"cx": NaN, "frames": [{"file_path": "images/a.ppm"}]})")),
              HasSubstr("transform_matrix is missing"));
  EXPECT_THAT(error_with("/is_fisheye", 1), HasSubstr("is_fisheye must be true or false"));
  EXPECT_THAT(error_with("/equirectangular", true), HasSubstr("not supported"));
  EXPECT_THAT(error_with("/camera_model", "PANORAMA"),
              HasSubstr("PANORAMA is not supported; undistort"));
  EXPECT_THAT(error_with("/camera_model", "EQUIRECTANGULAR"), HasSubstr("perspective views"));
  EXPECT_THAT(error_with("/camera_model", "FOV"), HasSubstr("\"camera_params\""));
  EXPECT_THAT(error_with("/camera_params", {1}), HasSubstr("camera_params needs \"camera_model\""));
  json root = TwoFrames();
  root.update({{"camera_model", "FOV"}, {"camera_params", {1, 2}}});
  EXPECT_THAT(ReadError(root), HasSubstr("camera_params: model FOV has 5 parameters, not 2"));
  root = TwoFrames();
  root.erase("h");
  EXPECT_THAT(ReadError(root), HasSubstr("h is missing"));
  root = TwoFrames();
  root.erase("fl_x");
  root.erase("fl_y");
  EXPECT_THAT(ReadError(root), HasSubstr("fl_x is missing"));
  root["camera_angle_x"] = 3.2;
  EXPECT_THAT(ReadError(root), HasSubstr("camera_angle_x must lie between 0 and 180"));
}

TEST_F(TransformsJson, NonFiniteNumbersAsPythonWritesThemAreNamed) {
  const std::string whole = TwoFrames().dump();
  for (const char* word : {"NaN", "Infinity", "-Infinity"}) {
    std::string text = whole;
    const std::string row = "[0,0,1,0]";
    text.replace(text.find(row), row.size(), std::string("[0,0,1,") + word + "]");
    EXPECT_THAT(ReadError(text), HasSubstr("frames[0].transform_matrix[2][3] must be a finite"));
  }
  // In a string these are letters.
  scratch_.WriteImage("NaN \"Infinity\".ppm", 20, 10);
  json root = TwoFrames();
  root["frames"][0]["file_path"] = "NaN \"Infinity\".ppm";
  EXPECT_EQ(Read(root).images[0].name, "NaN \"Infinity\".ppm");
}

TEST_F(TransformsJson, FileTruncatedAtAnyByteIsRefused) {
  const std::string whole = TwoFrames().dump();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    ASSERT_THAT(ReadError(whole.substr(0, length)), HasSubstr("transforms.json: parse error"));
  }
  EXPECT_THAT(ReadError(std::string(100000, '[')), HasSubstr("parse error"));
  EXPECT_THAT(ReadError(std::string("[1]")), HasSubstr("transforms.json: must be an object"));
  EXPECT_THAT(InputErrorOf([&] { ReadTransformsJson(scratch_.path()); }),
              HasSubstr("not a regular file"));
  EXPECT_THAT(InputErrorOf([&] { ReadTransformsJson(scratch_.path() / "absent.json"); }),
              HasSubstr("absent.json: no such file"));
}

}  // namespace
}  // namespace nerf::sfm
