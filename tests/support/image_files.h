#pragma once

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "nerf/image/image.h"
#include "tests/support/scratch_folder.h"

namespace nerf::test {

// A scratch folder for image files.
class ImageIo : public testing::Test {
 protected:
  std::filesystem::path File(const std::string& name) const { return folder_.path() / name; }
  int NumFiles() const {
    return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder_.path()),
                                          std::filesystem::directory_iterator()));
  }

 private:
  ScratchFolder folder_;
};

// Writes values unchanged, without the code under test.
template <class T>
void WriteRaw(const std::filesystem::path& path, OIIO::ImageSpec spec,
              const std::vector<T>& values) {
  auto output = OIIO::ImageOutput::create(path.string());
  ASSERT_TRUE(output) << OIIO::geterror();
  ASSERT_TRUE(output->open(path.string(), spec)) << output->geterror();
  ASSERT_TRUE(output->write_image(spec.format, values.data())) << output->geterror();
  ASSERT_TRUE(output->close());
}

// An image in which neighbouring pixels differ, with values of an 8-bit file.
inline Image GradientImage(int width, int height, int channels) {
  Image image(width, height, channels);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = static_cast<float>((i * 37 + i / 256) % 256) / 255.0f;
  }
  return image;
}

}  // namespace nerf::test
