// What other programs write into a transforms.json.
#include <gmock/gmock.h>

#include "tests/support/transforms_json_file.h"

namespace nerf::sfm {
namespace {

using nerf::test::TransformsJson;
using nerf::test::TwoFrames;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(TransformsJson, MatricesMayHaveThreeRowsOrBeFlat) {
  json root = TwoFrames();
  const json rows = {{1, 0, 0, 7}, {0, 1, 0, 8}, {0, 0, 1, 9}};
  json flat = json::array();
  for (const json& row : rows) {
    for (const json& value : row) flat.push_back(value);
  }
  for (const json& matrix : {rows, flat}) {
    root["frames"][0]["transform_matrix"] = matrix;
    EXPECT_EQ(Read(root).images[1].world_from_camera.translation(), Eigen::Vector3d(7, 8, 9));
  }
  flat.insert(flat.end(), {0, 0, 0, 1});
  root["frames"][0]["transform_matrix"] = flat;
  EXPECT_EQ(Read(root).images[1].world_from_camera.translation(), Eigen::Vector3d(7, 8, 9));
}

TEST_F(TransformsJson, AScaleThatAllAxesShareIsTakenOutWithAWarning) {
  json root = TwoFrames();
  for (const double scale : {0.01, 1.004, 25.0}) {
    root["frames"][0]["transform_matrix"] = {
        {scale, 0, 0, 7}, {0, scale, 0, 8}, {0, 0, scale, 9}, {0, 0, 0, 1}};
    const PosedImages posed = Read(root);
    EXPECT_TRUE(posed.images[1].world_from_camera.linear().isUnitary(1e-12));
    EXPECT_EQ(posed.images[1].world_from_camera.translation(), Eigen::Vector3d(7, 8, 9));
    EXPECT_THAT(posed.warnings, ElementsAre(HasSubstr("have a scale of")));
  }
  root["frames"][0]["transform_matrix"] = {{2, 0, 0, 7}, {0, 2, 0, 8}, {0, 0, 1, 9}, {0, 0, 0, 1}};
  EXPECT_THAT(ReadError(root), HasSubstr("different scales (2, 2, 1)"));
  root["frames"][0]["transform_matrix"] = {{2, 0, 0, 7}, {0, 2, 0, 8}, {0, 0, -2, 9}, {0, 0, 0, 1}};
  EXPECT_THAT(ReadError(root), HasSubstr("mirrored"));
}

TEST_F(TransformsJson, NullMeansAbsent) {
  json root = TwoFrames();
  root.update({{"k3", nullptr}, {"cx", nullptr}, {"camera_model", nullptr}});
  root["frames"][0].update({{"mask_path", nullptr}, {"fl_x", nullptr}});
  const PosedImages posed = Read(root);
  EXPECT_THAT(posed.cameras, ElementsAre(Camera{CameraModel::kPinhole, 20, 10, {30, 31, 10, 5}}));
  EXPECT_TRUE(posed.images[1].mask.empty());
  EXPECT_TRUE(posed.warnings.empty());
}

TEST_F(TransformsJson, MasksThatAreMissingAreAWarning) {
  json root = TwoFrames();
  scratch_.WriteImage("masks/a.png", 20, 10);
  root["frames"][0]["mask_path"] = "masks/absent.png";
  root["frames"][1]["mask_path"] = "masks/a.png";
  const PosedImages posed = Read(root);
  EXPECT_EQ(posed.images[0].mask.filename(), "a.png");
  EXPECT_TRUE(posed.images[1].mask.empty());
  EXPECT_THAT(posed.warnings, ElementsAre(testing::AllOf(HasSubstr("1 masks named by mask_path"),
                                                         HasSubstr("masks/absent.png"))));
}

TEST_F(TransformsJson, OtherEncodingsThanUtf8AreNamed) {
  EXPECT_THAT(ReadError(std::string("\xff\xfe{\0}\0", 6)), HasSubstr("UTF-16"));
  // Whatever a file contains, a message is UTF-8.
  const std::string error = ReadError(std::string("{\"frames\xff\xfe\": [}"));
  for (const char c : error) EXPECT_EQ(static_cast<unsigned char>(c) & 0x80, 0) << error;
}

}  // namespace
}  // namespace nerf::sfm
