// Models that are truncated, damaged or inconsistent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <string>
#include <utility>

#include "tests/support/colmap_model_folder.h"

namespace nerf::sfm {
namespace {

using nerf::test::BinaryColmapFiles;
using nerf::test::ColmapContents;
using nerf::test::ColmapFiles;
using nerf::test::InputErrorOf;
using nerf::test::SmallColmapContents;
using nerf::test::TextColmapFiles;
using testing::HasSubstr;

class ColmapModelErrors : public nerf::test::ColmapModel {};

TEST_F(ColmapModelErrors, BinaryTruncatedAtAnyByteIsRefused) {
  WriteImages();
  const ColmapFiles whole = BinaryColmapFiles(SmallColmapContents());
  for (const auto& [name, bytes] : {std::pair{"sparse/cameras.bin", whole.cameras},
                                    std::pair{"sparse/images.bin", whole.images},
                                    std::pair{"sparse/points3D.bin", whole.points}}) {
    WriteFiles(whole, ".bin");
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      scratch_.Write(name, bytes.substr(0, length));
      ASSERT_THAT(ReadError(), HasSubstr("truncated or damaged")) << name << " " << length;
    }
    scratch_.Write(name, bytes + 'x');
    EXPECT_THAT(ReadError(), HasSubstr("1 bytes follow the last record"));
  }
}

TEST_F(ColmapModelErrors, TextTruncatedAtAnyByteNeverCrashes) {
  WriteImages();
  const ColmapFiles whole = TextColmapFiles(SmallColmapContents());
  int refused = 0;
  for (const auto& [name, bytes] : {std::pair{"sparse/cameras.txt", whole.cameras},
                                    std::pair{"sparse/images.txt", whole.images},
                                    std::pair{"sparse/points3D.txt", whole.points}}) {
    WriteFiles(whole, ".txt");
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      scratch_.Write(name, bytes.substr(0, length));
      refused += ReadError() != "no error";
    }
  }
  EXPECT_GT(refused, 100);
}

TEST_F(ColmapModelErrors, AbsurdCountsAllocateNoMemory) {
  WriteImages();
  const ColmapFiles whole = BinaryColmapFiles(SmallColmapContents());
  for (const char byte : {'\xff', '\x7f'}) {
    for (const auto& [name, bytes] : {std::pair{"sparse/cameras.bin", whole.cameras},
                                      std::pair{"sparse/images.bin", whole.images},
                                      std::pair{"sparse/points3D.bin", whole.points}}) {
      WriteFiles(whole, ".bin");
      scratch_.Write(name, std::string(8, byte) + bytes.substr(8));
      EXPECT_THAT(ReadError(), HasSubstr("truncated or damaged"));
    }
    scratch_.Write("sparse/images.bin", std::string(8, byte) + whole.images.substr(8));
    EXPECT_THAT(InputErrorOf([&] { CountRegistered(Sparse()); }), HasSubstr("images.bin"));
  }
}

TEST_F(ColmapModelErrors, InvalidPosesAreRefusedByImage) {
  WriteImages();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ColmapContents contents = SmallColmapContents();
  contents.images[1].translation.y() = nan;
  WriteBinary(contents);
  EXPECT_THAT(ReadError(), HasSubstr("image 'a b.ppm': the pose is not finite"));
  contents = SmallColmapContents();
  contents.images[2].rotation.setZero();
  WriteBinary(contents);
  EXPECT_THAT(ReadError(), HasSubstr("image 'sub/b.ppm': the rotation quaternion"));
  contents = SmallColmapContents();
  contents.cameras[9].params[0] = nan;
  WriteBinary(contents);
  EXPECT_THAT(ReadError(), HasSubstr("cameras.bin: camera 9: a parameter is not finite"));
  std::filesystem::remove_all(Sparse());
  WriteFiles(TextColmapFiles(contents), ".txt");
  EXPECT_THAT(ReadError(), HasSubstr("cameras.txt:3: camera 9: a parameter is not finite"));
}

TEST_F(ColmapModelErrors, InconsistentFilesAreRefused) {
  WriteImages();
  ColmapContents contents = SmallColmapContents();
  contents.images[0].camera_id = 4;
  WriteBinary(contents);
  EXPECT_THAT(ReadError(), HasSubstr("image 'c.ppm': its camera 4 is not in"));
  contents = SmallColmapContents();
  contents.points[1].track[0].second = 3;
  WriteBinary(contents);
  EXPECT_THAT(ReadError(), HasSubstr("track of point 7 names 2D point 3 of image 8"));
  contents = SmallColmapContents();
  contents.images[1].name = "c.ppm";
  WriteBinary(contents);
  EXPECT_THAT(ReadError(), HasSubstr("image 'c.ppm' is listed twice"));
  contents = SmallColmapContents();
  contents.images[1].id = 8;
  WriteBinary(contents);
  EXPECT_THAT(ReadError(), HasSubstr("image id 8 is listed twice"));
  contents = SmallColmapContents();
  contents.images.clear();
  WriteBinary(contents);
  EXPECT_THAT(ReadError(), HasSubstr("no image is registered"));
}

TEST_F(ColmapModelErrors, WrongImageSizeIsNamedWithBothSizes) {
  WriteImages();
  WriteBinary(SmallColmapContents());
  scratch_.WriteImage("images/c.ppm", 6, 7);
  const std::string error = ReadError();
  EXPECT_THAT(error, HasSubstr("image 'c.ppm': the file is 6x7 pixels"));
  EXPECT_THAT(error, HasSubstr("12x8 of its camera 3"));
}

TEST_F(ColmapModelErrors, AMissingSecondLineIsNamed) {
  WriteImages();
  WriteFiles({"3 SIMPLE_RADIAL 12 8 10 6 4 0.1\n",
              "21 1 0 0 0 0 0 0 3 c.ppm\n22 1 0 0 0 1 0 0 3 sub/b.ppm\n", ""},
             ".txt");
  EXPECT_THAT(ReadError(), HasSubstr("images.txt:2: another image, where the second line of image "
                                     "'c.ppm' should be"));
}

TEST_F(ColmapModelErrors, LensesOfNewerVersionsAreNamedWithTheRemedy) {
  WriteImages();
  const auto error_of = [&](const std::string& camera) {
    WriteFiles({camera, "21 1 0 0 0 0 0 0 3 c.ppm\n\n", ""}, ".txt");
    return ReadError();
  };
  EXPECT_THAT(error_of("3 SIMPLE_DIVISION 12 8 10 6 4 0.1\n"),
              testing::AllOf(HasSubstr("cameras.txt:1: camera 3"), HasSubstr("SIMPLE_DIVISION"),
                             HasSubstr("colmap image_undistorter")));
  EXPECT_THAT(error_of("3 EQUIRECTANGULAR 12 8 12 8\n"), HasSubstr("perspective views"));
  std::filesystem::remove_all(Sparse());
  for (const auto& [id, name, params] :
       {std::tuple{11, "RAD_TAN_THIN_PRISM_FISHEYE", 16}, std::tuple{12, "SIMPLE_DIVISION", 4},
        std::tuple{17, "EQUIRECTANGULAR", 2}, std::tuple{99, "99", 4}}) {
    test::ColmapFiles files = BinaryColmapFiles(SmallColmapContents());
    std::string& cameras = files.cameras;
    cameras.resize(8 + 24 + 8 * static_cast<std::size_t>(params));
    cameras[0] = 1;  // one camera
    cameras[12] = static_cast<char>(id);
    WriteFiles(files, ".bin");
    EXPECT_THAT(ReadError(), testing::AllOf(HasSubstr(name), HasSubstr("not supported")));
  }
}

}  // namespace
}  // namespace nerf::sfm
