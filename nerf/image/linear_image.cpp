#include "nerf/image/linear_image.h"

#include <string>

#include "nerf/image/image_convert.h"
#include "nerf/image/image_io.h"
#include "nerf/image/oiio_files.h"

namespace nerf {
namespace {

bool IsCameraRaw(const OIIO::ImageInput& input) {
  return input.format_name() == std::string("raw");
}

bool IsCameraRaw(const std::filesystem::path& file) {
  const auto input = OpenImageInput(file);
  return input && IsCameraRaw(*input);
}

}  // namespace

bool StoresLinearLight(const std::filesystem::path& file) {
  const auto input = OpenImageInput(file);
  if (!input) return false;  // ReadImage reports why
  const int bits = input->spec().get_int_attribute(
      "oiio:BitsPerSample", 8 * static_cast<int>(input->spec().format.size()));
  return bits > 8 || IsCameraRaw(*input);
}

bool StoresIntegers(const std::filesystem::path& file) {
  const auto input = OpenImageInput(file);
  return !input || !input->spec().format.is_floating_point();
}

Image ReadLinearImage(const std::filesystem::path& file, InputEncoding encoding) {
  Image image = ReadStoredColors(file, true);
  const bool linear = encoding == InputEncoding::kLinear ||
                      (encoding == InputEncoding::kAuto && StoresLinearLight(file));
  if (linear && !IsCameraRaw(file)) image.encoding = ColorEncoding::kLinear;
  return image.encoding == ColorEncoding::kLinear ? image : ToLinear(image);
}

}  // namespace nerf
