#include "nerf/capture/normal_truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <matio.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "nerf/image/image_io.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Normals that differ from pixel to pixel, none at the first pixel.
Image SomeNormals() {
  Image normal(5, 3, 3, ColorEncoding::kLinear);
  for (std::size_t i = 3; i < normal.pixels.size(); i += 3) {
    const float x = 0.1f * static_cast<float>(i % 5), y = -0.05f * static_cast<float>(i / 5);
    const float z = std::sqrt(1 - x * x - y * y);
    normal.pixels[i] = x, normal.pixels[i + 1] = y, normal.pixels[i + 2] = z;
  }
  return normal;
}

// As MATLAB has it: columns of rows of channels, compressed.
void WriteMat(const fs::path& path, const Image& normal, const char* name) {
  std::size_t dims[3] = {static_cast<std::size_t>(normal.height),
                         static_cast<std::size_t>(normal.width), 3};
  std::vector<double> values;
  for (int c = 0; c < 3; ++c) {
    for (int x = 0; x < normal.width; ++x) {
      for (int y = 0; y < normal.height; ++y) {
        values.push_back(static_cast<double>(normal.At(x, y)[c]));
      }
    }
  }
  mat_t* const file = Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT5);
  ASSERT_NE(file, nullptr);
  double one = 1;
  std::size_t scalar[2] = {1, 1};
  for (matvar_t* const variable :
       {Mat_VarCreate("other", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, scalar, &one, 0),
        Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 3, dims, values.data(), 0)}) {
    Mat_VarWrite(file, variable, MAT_COMPRESSION_ZLIB);
    Mat_VarFree(variable);
  }
  Mat_Close(file);
}

TEST(NormalTruth, IsTheSameFromEveryFormat) {
  const test::ScratchFolder folder;
  const Image normal = SomeNormals();
  WriteMat(folder.path() / "Normal_gt.mat", normal, "Normal_gt");
  WriteMat(folder.path() / "other.mat", normal, "N");
  WriteImage(folder.path() / "normal.exr", normal);
  Image picture = normal;
  for (float& value : picture.pixels) value = (value + 1) / 2;
  picture.encoding = ColorEncoding::kSrgb;
  WriteImage(folder.path() / "normal.png", picture);
  for (const auto& [name, bound] : {std::pair{"Normal_gt.mat", 1e-4}, std::pair{"other.mat", 1e-4},
                                    std::pair{"normal.exr", 1e-4}, std::pair{"normal.png", 0.5}}) {
    const NormalError error = CompareNormals(normal, ReadNormalTruth(folder.path() / name), name);
    EXPECT_EQ(error.pixels, 14) << name;
    EXPECT_LT(error.mean, bound) << name;
  }
}

TEST(NormalTruth, ErrorsAreAngles) {
  Image normal = SomeNormals(), truth = normal;
  const double angle = 0.1;
  for (std::size_t i = 3; i < normal.pixels.size(); i += 3) {
    const auto x = static_cast<double>(normal.pixels[i]);
    const auto z = static_cast<double>(normal.pixels[i + 2]);
    truth.pixels[i + 1] = 0;  // both in the plane y = 0
    normal.pixels[i + 1] = 0;
    const double length = std::hypot(x, z);
    normal.pixels[i] = static_cast<float>(x / length);
    normal.pixels[i + 2] = static_cast<float>(z / length);
    truth.pixels[i] = static_cast<float>((x * std::cos(angle) + z * std::sin(angle)) / length);
    truth.pixels[i + 2] = static_cast<float>((z * std::cos(angle) - x * std::sin(angle)) / length);
  }
  const NormalError error = CompareNormals(normal, truth, "truth");
  EXPECT_NEAR(error.mean, angle * 180 / std::numbers::pi, 1e-4);
  EXPECT_NEAR(error.median, angle * 180 / std::numbers::pi, 1e-4);
}

TEST(NormalTruth, OfAnotherShapeIsNamed) {
  const test::ScratchFolder folder;
  const auto error = [&](const fs::path& file) {
    return test::InputErrorOf([&] { ReadNormalTruth(file); });
  };
  EXPECT_THAT(error(folder.Write("broken.mat", "not a MATLAB file")), HasSubstr("broken.mat"));
  EXPECT_THAT(error(folder.path() / "absent.mat"), HasSubstr("absent.mat"));
  // Cut short.
  Image large(64, 48, 3, ColorEncoding::kLinear);
  for (std::size_t i = 0; i < large.pixels.size(); i += 3) {
    const float x = 0.9f * static_cast<float>(i * 7919 % 1000) / 1000;
    large.pixels[i] = x, large.pixels[i + 2] = std::sqrt(1 - x * x);
  }
  WriteMat(folder.path() / "whole.mat", large, "Normal_gt");
  EXPECT_NO_THROW(ReadNormalTruth(folder.path() / "whole.mat"));
  const auto size = fs::file_size(folder.path() / "whole.mat");
  for (const double share : {0.3, 0.6, 0.9}) {
    fs::copy_file(folder.path() / "whole.mat", folder.path() / "cut.mat",
                  fs::copy_options::overwrite_existing);
    fs::resize_file(folder.path() / "cut.mat",
                    static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    EXPECT_THAT(error(folder.path() / "cut.mat"), HasSubstr("cut.mat")) << share;
  }
  EXPECT_THAT(test::InputErrorOf([] { CompareNormals(SomeNormals(), Image(5, 3, 3), "none.png"); }),
              HasSubstr("no normal where one was found"));
  EXPECT_THAT(test::InputErrorOf([] { CompareNormals(Image(4, 3, 3), Image(3, 4, 3), "gt.png"); }),
              testing::AllOf(HasSubstr("gt.png"), HasSubstr("3x4"), HasSubstr("4x3")));
}

}  // namespace
}  // namespace nerf
