#include "nerf/capture/olat_capture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <utility>

#include "nerf/capture/chrome_ball.h"
#include "nerf/image/image_io.h"
#include "tests/support/input_error_of.h"
#include "tests/support/lit_sphere.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kThreeLights = "0 0 1\n1 0 1\n0 1 1\n";

// A ball, 80 pixels wide, that mirrors a small bright light, in orthographic projection.
Image MirroringBall(const Vector3d& to_light) {
  Image photo(100, 90, 3, ColorEncoding::kLinear);
  for (int y = 0; y < 90; ++y) {
    for (int x = 0; x < 100; ++x) {
      const double nx = (x + 0.5 - 48) / 40;
      const double ny = -(y + 0.5 - 44) / 40;
      const double r2 = nx * nx + ny * ny;
      if (r2 > 1) continue;
      const Vector3d n(nx, ny, std::sqrt(1 - r2));
      const Vector3d mirrored = 2 * n.z() * n - Vector3d::UnitZ();
      const double value = 0.01 + (mirrored.dot(to_light) > 0.985 ? 1.0 : 0.0);
      std::fill_n(photo.At(x, y), 3, static_cast<float>(value));
    }
  }
  return photo;
}

Image BallMask() {
  Image mask = MirroringBall(Vector3d::UnitZ());
  for (float& value : mask.pixels) value = value > 0 ? 1.0f : 0.0f;
  return mask;
}

TEST(ChromeBall, FindsTheDirectionOfTheLight) {
  const BallOutline ball = FindBall(BallMask(), "mask.png");
  EXPECT_NEAR(ball.center.x(), 48, 0.1);
  EXPECT_NEAR(ball.center.y(), 44, 0.1);
  EXPECT_NEAR(ball.radius, 40, 0.2);
  for (const Vector3d& to_light : {Vector3d(0, 0, 1), Vector3d(0.4, 0.5, 0.8),
                                   Vector3d(-0.7, 0.2, 0.6), Vector3d(0.3, -0.9, 0.3)}) {
    const Vector3d l = to_light.normalized();
    const Vector3d found = LightFromHighlight(MirroringBall(l), ball, "ball.png");
    EXPECT_LT(test::DegreesBetween(found, l), 1.0) << l.transpose();
  }
}

TEST(ChromeBall, RejectsInvalidMasksAndPhotographsByName) {
  EXPECT_THAT(test::InputErrorOf([] { FindBall(Image(50, 50, 3), "mask.png"); }),
              HasSubstr("mask.png"));
  Image square(50, 50, 3);
  for (int y = 10; y < 40; ++y) {
    for (int x = 10; x < 20; ++x) *square.At(x, y) = 1;
  }
  EXPECT_THAT(test::InputErrorOf([&] { FindBall(square, "mask.png"); }), HasSubstr("not a disc"));
  const BallOutline ball{{25, 25}, 20};
  EXPECT_THAT(test::InputErrorOf([&] { LightFromHighlight(Image(50, 50, 3), ball, "b.png"); }),
              AllOf(HasSubstr("b.png"), HasSubstr("no highlight")));
}

TEST(OlatCapture, OrdersImagesByNumberAndFindsTheMask) {
  const test::ScratchFolder scratch;
  for (const char* name : {"a.10.png", "a.2.png", "a.1.png"}) scratch.WriteImage(name, 8, 6);
  scratch.WriteImage("a.mask.png", 8, 6);
  scratch.Write("lights.txt", kThreeLights);
  const OlatCapture capture = FindOlatCapture(scratch.path(), {});
  ASSERT_EQ(capture.images.size(), 3u);
  EXPECT_EQ(capture.images[0].filename(), "a.1.png");
  EXPECT_EQ(capture.images[1].filename(), "a.2.png");
  EXPECT_EQ(capture.images[2].filename(), "a.10.png");
  ASSERT_EQ(capture.masks.size(), 1u);
  EXPECT_EQ(capture.masks[0].filename(), "a.mask.png");
  EXPECT_EQ(capture.width, 8);
  EXPECT_EQ(capture.height, 6);
}

TEST(OlatCapture, UsesAListAndLightsFromTheParentFolder) {
  const test::ScratchFolder scratch;
  for (const char* name : {"x.png", "y.png", "z.png"}) {
    scratch.WriteImage(std::filesystem::path("vase") / name, 8, 6);
  }
  scratch.Write("vase.txt", "3\r\nset/vase/z.png\r\nset/vase/x.png\r\nset/vase/y.png\r\n");
  scratch.Write("lights.txt", kThreeLights);
  for (const char* given : {"", "vase", "vase/"}) {
    const OlatCapture capture = FindOlatCapture(scratch.path() / given, {});
    EXPECT_EQ(capture.name, "vase");
    EXPECT_EQ(capture.images[0].filename(), "z.png");
    EXPECT_EQ(capture.images[2].filename(), "y.png");
  }
}

TEST(OlatCapture, UsesTheChromeBallIfThereIsNoLightFile) {
  const test::ScratchFolder scratch;
  const std::vector<Vector3d> directions = {Vector3d(0, 0, 1), Vector3d(0.5, 0, 0.8).normalized(),
                                            Vector3d(0, 0.5, 0.8).normalized()};
  std::filesystem::create_directories(scratch.path() / "chrome");
  WriteImage(scratch.path() / "chrome/mask.png", BallMask());
  for (int i = 0; i < 3; ++i) {
    scratch.WriteImage(fmt::format("cup{}.png", i), 8, 6);
    WriteImage(scratch.path() / fmt::format("chrome/ball{}.png", i), MirroringBall(directions[i]));
  }
  const OlatCapture capture = FindOlatCapture(scratch.path(), {});
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(test::DegreesBetween(capture.lights[i].to_light, directions[i]), 1.0);
  }
}

TEST(OlatCapture, HasTheNameOfItsFolderForRelativePaths) {
  const test::ScratchFolder scratch;
  for (const char* name : {"cup/1.png", "cup/2.png", "cup/3.png"}) scratch.WriteImage(name, 8, 6);
  scratch.Write("cup/lights.txt", kThreeLights);
  scratch.Write("cup/inner/notes.txt", "x");
  const auto here = std::filesystem::current_path();
  for (const auto& [from, given] : {std::pair("cup", "."), {"cup", "./"}, {"cup/inner", ".."}}) {
    std::filesystem::current_path(scratch.path() / from);
    const OlatCapture capture = FindOlatCapture(given, {});
    std::filesystem::current_path(here);
    EXPECT_EQ(capture.name, "cup") << given;
  }
}

TEST(OlatCapture, RejectsOutputInItsFolder) {
  const test::ScratchFolder scratch;
  for (const char* name : {"a/1.png", "a/2.png", "a/3.png"}) scratch.WriteImage(name, 8, 6);
  scratch.Write("a/lights.txt", kThreeLights);
  const OlatCapture capture = FindOlatCapture(scratch.path() / "a", {});
  for (const char* output : {"a", "a/", "a/../a"}) {
    EXPECT_THAT(test::InputErrorOf([&] { CheckOutputFolder(capture, scratch.path() / output); }),
                HasSubstr("--output"));
  }
  for (const char* output : {"b", "a/relit", "."}) {
    EXPECT_EQ(test::InputErrorOf([&] { CheckOutputFolder(capture, scratch.path() / output); }),
              "no error");
  }
}

// The next run searches the folder that was given as well.
TEST(OlatCapture, RejectsOutputInItsFoldersIfFoundInASubFolder) {
  const test::ScratchFolder scratch;
  for (const char* name : {"ph/cat/1.png", "ph/cat/2.png", "ph/cat/3.png", "ph/chrome/1.png"}) {
    scratch.WriteImage(name, 8, 6);
  }
  scratch.Write("ph/lights.txt", kThreeLights);
  const OlatCapture capture = FindOlatCapture(scratch.path() / "ph", {});
  for (const char* output : {"ph", "ph/", "ph/cat", "ph/chrome"}) {
    EXPECT_THAT(test::InputErrorOf([&] { CheckOutputFolder(capture, scratch.path() / output); }),
                AllOf(HasSubstr("--output"), HasSubstr(output)));
  }
}

TEST(OlatCapture, IgnoresFoldersOfResults) {
  const test::ScratchFolder scratch;
  for (const char* name : {"ph/cat/1.png", "ph/cat/2.png", "ph/cat/3.png"}) {
    scratch.WriteImage(name, 8, 6);
  }
  scratch.Write("ph/lights.txt", kThreeLights);
  for (const char* name : {"ph/cat-normals/normals.exr", "ph/cat-relit/relit.exr"}) {
    scratch.WriteImage(name, 8, 6);
  }
  EXPECT_EQ(FindOlatCapture(scratch.path() / "ph", {}).name, "cat");
}

TEST(OlatCapture, ErrorsNameWhatIsMissing) {
  const test::ScratchFolder scratch;
  const auto error = [&](const std::filesystem::path& folder) {
    return test::InputErrorOf([&] { FindOlatCapture(scratch.path() / folder, {}); });
  };
  EXPECT_THAT(error("nowhere"), HasSubstr("no such folder"));
  EXPECT_THAT(error(""), HasSubstr("no images"));
  for (const char* name : {"a/1.png", "a/2.png", "a/3.png"}) scratch.WriteImage(name, 8, 6);
  EXPECT_THAT(error("a"), HasSubstr("lights.txt"));
  scratch.Write("a/lights.txt", "0 0 1\n1 0 1\n");
  EXPECT_THAT(error("a"), HasSubstr("2 lights for 3 images"));
  scratch.Write("a/lights.txt", kThreeLights);
  scratch.WriteImage("a/3.png", 9, 6);
  EXPECT_THAT(error("a"), AllOf(HasSubstr("3.png"), HasSubstr("9 x 6")));
  scratch.WriteImage("b/1.png", 8, 6);
  EXPECT_THAT(error(""), HasSubstr("2 subjects"));
}

TEST(OlatCapture, ReadsAFolderOfDiLiGenTAsItIs) {
  const test::ScratchFolder scratch;
  for (const char* name : {"001.png", "002.png", "010.png", "mask.png", "Normal_gt.png"}) {
    scratch.WriteImage(std::filesystem::path("ballPNG") / name, 8, 6);
  }
  scratch.Write("ballPNG/filenames.txt", "010.png\n001.png\n002.png\n");
  scratch.Write("ballPNG/light_directions.txt", kThreeLights);
  scratch.Write("ballPNG/light_intensities.txt", "1 1 1\n2 2 2\n3 3 3\n");
  const OlatCapture capture = FindOlatCapture(scratch.path() / "ballPNG", {});
  ASSERT_EQ(capture.images.size(), 3u);
  EXPECT_EQ(capture.images[0].filename(), "010.png");
  ASSERT_EQ(capture.masks.size(), 1u);
  EXPECT_NEAR(capture.lights[2].irradiance.x(), 3 * std::numbers::pi, 1e-12);
  // Without the list, in the order of the numbers.
  std::filesystem::remove(scratch.path() / "ballPNG/filenames.txt");
  EXPECT_EQ(FindOlatCapture(scratch.path() / "ballPNG", {}).images[2].filename(), "010.png");
}

TEST(OlatCapture, FollowsTheNamesInAnLpFile) {
  const test::ScratchFolder scratch;
  for (const char* name : {"a.png", "b.png", "c.png"}) scratch.WriteImage(name, 8, 6);
  scratch.Write("dome.lp", "3\nscans/c.jpg 0 0 1\nscans/A.jpg 1 0 0\nscans/b.jpg 0 1 0\n");
  const OlatCapture capture = FindOlatCapture(scratch.path(), {});
  EXPECT_TRUE(capture.lights[0].to_light.isApprox(Vector3d::UnitX()));
  EXPECT_TRUE(capture.lights[1].to_light.isApprox(Vector3d::UnitY()));
  EXPECT_TRUE(capture.lights[2].to_light.isApprox(Vector3d::UnitZ()));
  scratch.Write("dome.lp", "c.jpg 0 0 1\na.jpg 1 0 0\n");
  EXPECT_THAT(test::InputErrorOf([&] { FindOlatCapture(scratch.path(), {}); }),
              HasSubstr("no light for the image b.png"));
}

TEST(OlatCapture, OfACarnivalMaskHasImages) {
  const test::ScratchFolder scratch;
  for (const char* name : {"mask_1.png", "mask_2.png", "mask_3.png"})
    scratch.WriteImage(name, 8, 6);
  scratch.Write("lights.txt", kThreeLights);
  const OlatCapture capture = FindOlatCapture(scratch.path(), {});
  EXPECT_EQ(capture.images.size(), 3u);
  EXPECT_TRUE(capture.masks.empty());
  scratch.WriteImage("mask.png", 8, 6);
  EXPECT_EQ(FindOlatCapture(scratch.path(), {}).masks.size(), 1u);
}

}  // namespace
}  // namespace nerf
