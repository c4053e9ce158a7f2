#pragma once

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace nerf::test {

// Writes an image whose left half is dark and whose right half is bright.
//   orientation  EXIF orientation, 1 to 8
//   format       of the values, if the file format supports it
inline void WritePhoto(const std::filesystem::path& file, int width, int height,
                       int orientation = 1, OIIO::TypeDesc format = OIIO::TypeUInt8,
                       int channels = 3) {
  OIIO::ImageSpec spec(width, height, channels, format);
  spec.attribute("Orientation", orientation);
  // Photographs are not the same byte for byte.
  spec.attribute("ImageDescription", file.filename().string());
  std::vector<float> pixels(static_cast<std::size_t>(width) * height * channels);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const int x = static_cast<int>(i / channels) % width;
    pixels[i] = 2 * x < width ? 0.1f : 0.9f;
  }
  const auto output = OIIO::ImageOutput::create(file.string());
  ASSERT_TRUE(output && output->open(file.string(), spec)) << file;
  ASSERT_TRUE(output->write_image(OIIO::TypeFloat, pixels.data())) << file;
  ASSERT_TRUE(output->close()) << file;
}

inline std::string FileBytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace nerf::test
