#include "nerf/output/camera_path_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "nerf/base/input_error.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

class CameraPathJson : public testing::Test {
 protected:
  CameraPathJson() { fs::create_directories(folder_); }
  ~CameraPathJson() override { fs::remove_all(folder_); }

  fs::path Write(const std::string& text) const {
    std::ofstream(folder_ / "path.json") << text;
    return folder_ / "path.json";
  }
  CameraPath Read(const json& value) const { return ReadCameraPath(Write(value.dump())); }

  std::string ErrorOf(const std::string& text) const {
    return Catch([&] { ReadCameraPath(Write(text)); });
  }
  static std::string Catch(const std::function<void()>& call) {
    try {
      call();
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  }

  fs::path folder_ = fs::temp_directory_path() / ("nerf_path_json_" + std::to_string(::getpid()));
};

// OpenGL axes: at z = 2 without rotation, the camera looks down at the origin.
const json kAboveOrigin = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 2, 0, 0, 0, 1};
const json kNested = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 2}, {0, 0, 0, 1}};

json OneCamera(const json& matrix) {
  return {{"render_width", 160},
          {"render_height", 90},
          {"camera_type", "perspective"},
          {"camera_path", {{{"camera_to_world", matrix}, {"fov", 60}, {"aspect", 1.7778}}}},
          {"fps", 24},
          {"seconds", 4}};
}

void ExpectLooksDownAtTheOrigin(const PathPose& pose) {
  EXPECT_LT((pose.world_from_camera.translation() - Eigen::Vector3d(0, 0, 2)).norm(), 1e-12);
  // In OpenCV axes the origin is ahead, and the y axis of the world is up in the picture.
  EXPECT_LT((pose.world_from_camera.inverse() * Eigen::Vector3d::Zero() - Eigen::Vector3d(0, 0, 2))
                .norm(),
            1e-12);
  const Eigen::Vector2d up =
      *PixelFromPoint(pose.camera, pose.world_from_camera.inverse() * Eigen::Vector3d(0, 0.1, 0));
  EXPECT_LT(up.y(), PrincipalPoint(pose.camera).y());
  EXPECT_NEAR(up.x(), PrincipalPoint(pose.camera).x(), 1e-9);
}

TEST_F(CameraPathJson, ReadsOpenGLAxes) {
  const CameraPath path = Read(OneCamera(kAboveOrigin));
  ASSERT_EQ(path.poses.size(), 1);
  ExpectLooksDownAtTheOrigin(path.poses[0]);
  EXPECT_EQ(path.poses[0].camera.width, 160);
  EXPECT_EQ(path.poses[0].camera.height, 90);
  EXPECT_NEAR(path.poses[0].camera.params[0], 45 / std::tan(M_PI / 6), 1e-9);
  EXPECT_EQ(path.frames_per_second, 24);
}

TEST_F(CameraPathJson, MatricesMayBeNestedOrWithoutTheLastRow) {
  json rows_of_three = kNested;
  rows_of_three.erase(3);
  json flat = kAboveOrigin;
  flat.erase(flat.begin() + 12, flat.end());
  for (const json& matrix : {kNested, rows_of_three, flat}) {
    ExpectLooksDownAtTheOrigin(Read(OneCamera(matrix)).poses[0]);
  }
}

TEST_F(CameraPathJson, SizeCanBeOverriddenAndKeepsTheAngle) {
  const fs::path file = Write(OneCamera(kAboveOrigin).dump());
  const Camera wide = ReadCameraPath(file, 320).poses[0].camera;
  EXPECT_EQ(wide.width, 320);
  EXPECT_EQ(wide.height, 180);
  EXPECT_NEAR(wide.params[0], 90 / std::tan(M_PI / 6), 1e-9);
  const Camera low = ReadCameraPath(file, {}, 45).poses[0].camera;
  EXPECT_EQ(low.width, 80);
  const Camera both = ReadCameraPath(file, 50, 40).poses[0].camera;
  EXPECT_EQ(both.width, 50);
  EXPECT_EQ(both.height, 40);
}

TEST_F(CameraPathJson, TimeComesFromFpsElseFromSeconds) {
  json file = OneCamera(kAboveOrigin);
  for (int i = 0; i < 7; ++i) file["camera_path"].push_back(file["camera_path"][0]);
  file["fps"] = 10;
  EXPECT_DOUBLE_EQ(Read(file).poses[7].seconds, 0.7);
  file.erase("fps");
  EXPECT_DOUBLE_EQ(Read(file).frames_per_second, 2);
  file.erase("seconds");
  EXPECT_DOUBLE_EQ(Read(file).frames_per_second, 30);
}

TEST_F(CameraPathJson, RejectsOtherTypesOfCameraByName) {
  json file = OneCamera(kAboveOrigin);
  file["camera_type"] = "equirectangular";
  EXPECT_THAT(ErrorOf(file.dump()), testing::AllOf(HasSubstr("path.json"), HasSubstr("camera_type"),
                                                   HasSubstr("equirectangular")));
}

TEST_F(CameraPathJson, ErrorsNameFileAndKey) {
  const auto with = [](const std::string& pointer, const json& value) {
    json file = OneCamera(kAboveOrigin);
    file[json::json_pointer(pointer)] = value;
    return file.dump();
  };
  EXPECT_THAT(ErrorOf("{"), HasSubstr("path.json"));
  EXPECT_THAT(ErrorOf("[]"), HasSubstr("path.json"));
  EXPECT_THAT(ErrorOf("{}"), HasSubstr("camera_path"));
  EXPECT_THAT(ErrorOf(with("/camera_path", json::array())), HasSubstr("camera_path"));
  EXPECT_THAT(ErrorOf(with("/camera_path/0", 3)), HasSubstr("camera_path[0]"));
  EXPECT_THAT(ErrorOf(with("/camera_path/0/fov", 180)), HasSubstr("camera_path[0].fov"));
  EXPECT_THAT(ErrorOf(with("/camera_path/0/fov", "60")), HasSubstr("camera_path[0].fov"));
  EXPECT_THAT(ErrorOf(with("/render_width", 1e12)), HasSubstr("render_width"));
  EXPECT_THAT(ErrorOf(with("/render_width", 1.5)), HasSubstr("render_width"));
  EXPECT_THAT(ErrorOf(with("/fps", 0)), HasSubstr("fps"));
  const std::string matrix = "/camera_path/0/camera_to_world";
  const auto named = HasSubstr("camera_path[0].camera_to_world");
  EXPECT_THAT(ErrorOf(with(matrix, json::array({1, 2, 3}))), named);
  EXPECT_THAT(ErrorOf(with(matrix, "unit")), named);
  EXPECT_THAT(ErrorOf(with(matrix + "/0", "one")), named);
  EXPECT_THAT(ErrorOf(with(matrix + "/0", 5)), named);  // not a rotation
  EXPECT_THAT(ErrorOf(with(matrix, {{{{1}}}, 1})), named);
  EXPECT_THAT(Catch([&] { ReadCameraPath(folder_ / "none.json"); }), HasSubstr("none.json"));
}

class PoseJson : public CameraPathJson {
 protected:
  PoseJson() {
    images_.cameras.push_back({CameraModel::kSimpleRadial, 80, 60, {70, 41, 29, 0.1}});
    images_.images.emplace_back().world_from_camera.setIdentity();
  }
  PathPose Read(const json& value) const { return ReadPose(Write(value.dump()), images_); }
  PosedImages images_;
};

TEST_F(PoseJson, UsesTheFirstCameraByDefault) {
  const PathPose pose = Read({{"transform_matrix", kNested}});
  ExpectLooksDownAtTheOrigin(pose);
  EXPECT_EQ(pose.camera, images_.cameras[0]);
}

TEST_F(PoseJson, ReadsAFieldOfView) {
  const PathPose pose =
      Read({{"camera_to_world", kAboveOrigin}, {"fov", 90}, {"w", 200}, {"h", 100}});
  ExpectLooksDownAtTheOrigin(pose);
  EXPECT_EQ(pose.camera, PinholeFromFov(200, 100, M_PI / 2));
  EXPECT_EQ(Read({{"camera_to_world", kAboveOrigin}, {"fov", 90}}).camera.width, 80);
}

TEST_F(PoseJson, ReadsTheLensKeysOfATransformsJson) {
  const Camera camera =
      Read({{"transform_matrix", kNested}, {"fl_x", 50}, {"w", 40}, {"h", 30}, {"k1", 0.2}}).camera;
  EXPECT_EQ(camera.width, 40);
  EXPECT_DOUBLE_EQ(FocalLength(camera), 50);
  EXPECT_EQ(camera.model, CameraModel::kOpenCV);
}

TEST_F(PoseJson, NamesTheMissingMatrix) {
  EXPECT_THAT(Catch([&] {
                Read({{"fov", 30}});
              }),
              testing::AllOf(HasSubstr("path.json"), HasSubstr("transform_matrix")));
}

}  // namespace
}  // namespace nerf
