#include "nerf/capture/photometric_maps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>

#include "nerf/capture/photometric_folder.h"
#include "nerf/image/image_io.h"
#include "nerf/light/light_file.h"
#include "tests/support/input_error_of.h"
#include "tests/support/lit_sphere.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_dng.h"

namespace nerf {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int kRadius = 30;
constexpr int kSize = 2 * kRadius + 5;
const Color kAlbedo(0.7, 0.4, 0.2);

Vector3d NormalAt(int x, int y) {
  const double nx = (x - kSize / 2) / double(kRadius);
  const double ny = -(y - kSize / 2) / double(kRadius);
  const double r2 = nx * nx + ny * ny;
  return r2 < 1 ? Vector3d(nx, ny, std::sqrt(1 - r2)) : Vector3d::Zero();
}

// Writes images of a coloured diffuse sphere under lights of different colours.
//   scale  factor of all values
void WriteSphereCapture(const std::filesystem::path& folder, const char* ending = ".exr",
                        float scale = 1) {
  std::vector<DirectionalLight> lights = test::RingOfLights(12, 45);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    lights[i].irradiance *= Color(1.0, 0.9, 0.8) * (i % 2 == 0 ? 1.0 : 0.5);
  }
  Image mask(kSize, kSize, 3);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    Image photo(kSize, kSize, 3, ColorEncoding::kLinear);
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const Vector3d n = NormalAt(x, y);
        if (n.isZero()) continue;
        std::fill_n(mask.At(x, y), 3, 1.0f);
        const Color b = kAlbedo * lights[i].irradiance / std::numbers::pi *
                        std::max(0.0, n.dot(lights[i].to_light));
        for (int c = 0; c < 3; ++c) photo.At(x, y)[c] = scale * static_cast<float>(b[c]);
      }
    }
    WriteImage(folder / (std::to_string(i) + ending), photo);
  }
  WriteImage(folder / "mask.png", mask);
  WriteLights(folder / "lights.txt", lights);
}

double MeanErrorOfSphere(const PhotometricMaps& maps) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const Vector3d n = NormalAt(x, y);
      if (n.isZero()) continue;
      const float* found = maps.normal.At(x, y);
      sum += test::DegreesBetween(Vector3d(found[0], found[1], found[2]), n);
      ++count;
    }
  }
  return sum / count;
}

TEST(PhotometricMaps, MatchASphereInFiles) {
  const test::ScratchFolder scratch;
  WriteSphereCapture(scratch.path());
  const auto capture = FindOlatCapture(scratch.path(), {});
  const auto maps = SolvePhotometricStereo(capture, InputEncoding::kAuto, {});
  EXPECT_LT(MeanErrorOfSphere(maps), 0.05);
  EXPECT_EQ(maps.unsolved_pixels, 0);
  const float* albedo = maps.albedo.At(kSize / 2 + 5, kSize / 2);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(albedo[c], kAlbedo[c], 1e-4);
  EXPECT_EQ(*maps.normal.At(0, 0), 0);
  // Relit by the first light, it matches the first photograph.
  const Image relit = RelitByNormals(maps, capture.lights[0]);
  const Image photo = ReadImage(capture.images[0], true);
  EXPECT_NEAR(relit.At(kSize / 2, kSize / 2)[0], photo.At(kSize / 2, kSize / 2)[0], 1e-4);
}

TEST(PhotometricMaps, AreWithinADegreeForEightBitImages) {
  const test::ScratchFolder scratch;
  WriteSphereCapture(scratch.path(), ".png");
  const OlatCapture capture = FindOlatCapture(scratch.path(), {});
  EXPECT_EQ(EncodingByResidual(capture), InputEncoding::kSrgb);
  const auto maps = SolvePhotometricStereo(capture, InputEncoding::kAuto, {});
  const double error = MeanErrorOfSphere(maps);
  std::cout << "8-bit sRGB files: " << error << " degrees\n";
  EXPECT_LT(error, 1);
}

TEST(PhotometricMaps, AreWrittenAsPicturesMeasurementsAndAMesh) {
  const test::ScratchFolder scratch;
  WriteSphereCapture(scratch.path());
  const auto maps =
      SolvePhotometricStereo(FindOlatCapture(scratch.path(), {}), InputEncoding::kAuto, {});
  WritePhotometricFolder(scratch.path() / "out", maps);
  for (const char* name : {"normals.png", "normals.exr", "albedo.png", "albedo.exr", "residual.png",
                           "residual.exr", "relit.png", "depth.ply"}) {
    EXPECT_TRUE(std::filesystem::exists(scratch.path() / "out" / name)) << name;
  }
  const Image normals = ReadImage(scratch.path() / "out/normals.exr", true);
  EXPECT_EQ(normals.pixels, maps.normal.pixels);
}

TEST(PhotometricMaps, RejectBlackAndSaturatedImagesByName) {
  const test::ScratchFolder scratch;
  WriteSphereCapture(scratch.path(), ".png");
  const auto error = [&] {
    return test::InputErrorOf([&] {
      SolvePhotometricStereo(FindOlatCapture(scratch.path(), {}), InputEncoding::kAuto, {});
    });
  };
  Image flat(kSize, kSize, 3);
  WriteImage(scratch.path() / "4.png", flat);
  EXPECT_THAT(error(), AllOf(HasSubstr("4.png"), HasSubstr("black")));
  std::ranges::fill(flat.pixels, 1.0f);
  WriteImage(scratch.path() / "4.png", flat);
  EXPECT_THAT(error(), AllOf(HasSubstr("4.png"), HasSubstr("100 %"), HasSubstr("saturated")));
  std::ranges::fill(flat.pixels, 0.0f);
  WriteImage(scratch.path() / "mask.png", flat);
  EXPECT_THAT(error(), AllOf(HasSubstr("mask.png"), HasSubstr("black")));
}

TEST(PhotometricMaps, AreTheSameInLittleMemory) {
  const test::ScratchFolder scratch;
  WriteSphereCapture(scratch.path());
  const OlatCapture capture = FindOlatCapture(scratch.path(), {});
  const auto whole = SolvePhotometricStereo(capture, InputEncoding::kAuto, {});
  const auto parts = SolvePhotometricStereo(capture, InputEncoding::kAuto, {}, 12 * 13 * 1000);
  EXPECT_EQ(parts.normal.pixels, whole.normal.pixels);
  EXPECT_EQ(parts.albedo.pixels, whole.albedo.pixels);
  EXPECT_EQ(parts.residual.pixels, whole.residual.pixels);
  EXPECT_EQ(parts.pixels, whole.pixels);
  EXPECT_EQ(parts.robust_pixels, whole.robust_pixels);
  EXPECT_EQ(parts.median_residual, whole.median_residual);
}

// Integers can be saturated; floats have an arbitrary unit.
TEST(PhotometricMaps, AcceptFloatsInAnyUnit) {
  for (const float scale : {1e-6f, 1.0f / 0.7f, 1e4f}) {
    const test::ScratchFolder scratch;
    WriteSphereCapture(scratch.path(), ".exr", scale);
    StereoOptions options;
    options.method = StereoMethod::kLeastSquares;
    const auto maps =
        SolvePhotometricStereo(FindOlatCapture(scratch.path(), {}), InputEncoding::kAuto, options);
    // At the second scale the brightest red is 1, which must not be taken for saturated.
    const float* albedo = maps.albedo.At(kSize / 2, kSize / 2);
    EXPECT_NEAR(albedo[0] / scale, kAlbedo[0], 1e-4) << scale;
    EXPECT_EQ(maps.unsolved_pixels, 0) << scale;
  }
}

// Camera raw files are linear, even though their decoder applies a transfer function.
TEST(PhotometricMaps, ReadCameraRawAsLinearLight) {
  const test::ScratchFolder scratch;
  const auto lights = test::RingOfLights(12, 45);
  WriteLights(scratch.path() / "lights.txt", lights);
  const Vector3d normal = Vector3d(0.25, -0.15, 0.9).normalized();
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const double b = 0.8 * std::max(0.0, normal.dot(lights[i].to_light));
    scratch.Write(std::to_string(i) + ".dng", test::TinyDng(32, 32, [&](int, int) {
                    return static_cast<std::uint16_t>(65535 * b);
                  }));
  }
  const OlatCapture capture = FindOlatCapture(scratch.path(), {});
  EXPECT_EQ(EncodingByResidual(capture), InputEncoding::kLinear);
  const auto maps = SolvePhotometricStereo(capture, InputEncoding::kAuto, {});
  const float* found = maps.normal.At(16, 16);
  EXPECT_LT(test::DegreesBetween(Vector3d(found[0], found[1], found[2]), normal), 0.1);
}

OlatCapture Cat() { return FindOlatCapture(std::string(NERF_TEST_DATA) + "/photometric", {}); }

TEST(PhotometricMaps, OfTheCatHaveLightsThatAgreeWithItsChromeBall) {
  const OlatCapture cat = Cat();
  ASSERT_EQ(cat.images.size(), 12u);
  EXPECT_EQ(cat.images[2].filename(), "cat.2.tga");
  const auto by_ball = LightsFromChrome(cat, InputEncoding::kAuto);
  double sum = 0;
  for (int i = 0; i < 12; ++i) {
    sum += test::DegreesBetween(by_ball[i].to_light, cat.lights[i].to_light);
  }
  std::cout << "lights.txt and chrome ball: " << sum / 12 << " degrees apart on average\n";
  EXPECT_LT(sum / 12, 5);  // a mirrored axis would make it tens of degrees
}

// There is no ground truth for the cat, but the prediction of a held-out photograph can be
// measured.
TEST(PhotometricMaps, OfTheCatPredictAHeldOutPhotograph) {
  OlatCapture cat = Cat();
  const auto light = cat.lights[4];
  const InputEncoding encoding = EncodingByResidual(cat);
  EXPECT_EQ(encoding, InputEncoding::kLinear);
  const Image photo = ReadLinearImage(cat.images[4], encoding);
  cat.lights.erase(cat.lights.begin() + 4);
  cat.images.erase(cat.images.begin() + 4);
  const auto maps = SolvePhotometricStereo(cat, encoding, {});
  const Image relit = RelitByNormals(maps, light);
  double error = 0;
  double sum = 0;
  for (std::size_t i = 0; i < relit.pixels.size(); ++i) {
    if (maps.albedo.pixels[i] == 0) continue;
    error += std::abs(relit.pixels[i] - photo.pixels[i]);
    sum += photo.pixels[i];
  }
  std::cout << "image 4 of the cat, predicted from the others: " << 100 * error / sum
            << " % error\n";
  EXPECT_LT(error / sum, 0.12);
  EXPECT_LT(maps.unsolved_pixels, maps.pixels / 100);
}

}  // namespace
}  // namespace nerf
