#include "nerf/image/linear_image.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <string>

#include "nerf/image/image_convert.h"
#include "nerf/image/image_io.h"

namespace nerf {
namespace {

Image WithoutAlpha(const Image& image) {
  Image rgb(image.width, image.height, 3, image.encoding);
  const std::size_t count = rgb.pixels.size() / 3;
  for (std::size_t i = 0; i < count; ++i) {
    std::copy_n(image.pixels.data() + i * image.channels, 3, rgb.pixels.data() + i * 3);
  }
  return rgb;
}

bool IsCameraRaw(const OIIO::ImageInput& input) {
  return input.format_name() == std::string("raw");
}

bool IsCameraRaw(const std::filesystem::path& file) {
  const auto input = OIIO::ImageInput::open(file.string());
  return input && IsCameraRaw(*input);
}

}  // namespace

bool StoresLinearLight(const std::filesystem::path& file) {
  const auto input = OIIO::ImageInput::open(file.string());
  if (!input) return false;  // ReadImage reports why
  const int bits = input->spec().get_int_attribute(
      "oiio:BitsPerSample", 8 * static_cast<int>(input->spec().format.size()));
  return bits > 8 || IsCameraRaw(*input);
}

bool StoresIntegers(const std::filesystem::path& file) {
  const auto input = OIIO::ImageInput::open(file.string());
  return !input || !input->spec().format.is_floating_point();
}

Image ReadLinearImage(const std::filesystem::path& file, InputEncoding encoding) {
  Image image = ReadImage(file, true);
  if (image.channels > 3) image = WithoutAlpha(image);
  const bool linear = encoding == InputEncoding::kLinear ||
                      (encoding == InputEncoding::kAuto && StoresLinearLight(file));
  if (linear && !IsCameraRaw(file)) image.encoding = ColorEncoding::kLinear;
  return image.encoding == ColorEncoding::kLinear ? image : ToLinear(image);
}

}  // namespace nerf
