#include "sfm/image_files.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>
#include <system_error>

namespace fs = std::filesystem;

namespace sfm {

bool HasImageEnding(const fs::path& file) {
  static constexpr std::array<std::string_view, 13> kEndings = {
      ".jpg",  ".jpeg", ".png", ".tif", ".tiff", ".exr", ".hdr",
      ".webp", ".bmp",  ".tga", ".ppm", ".jp2",  ".dpx"};
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

std::vector<fs::path> ImageFilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const fs::path& file = it->path();
    std::error_code unreadable;
    if (HasImageEnding(file) && file.filename().string().front() != '.' &&
        it->is_regular_file(unreadable)) {
      files.push_back(file);
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::optional<ImageSize> ReadImageSize(const fs::path& file) {
  const auto input = OIIO::ImageInput::open(file.string());
  if (!input) {
    OIIO::geterror();  // fetched, or OpenImageIO prints it when the program ends
    return std::nullopt;
  }
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width <= 0 || spec.height <= 0) return std::nullopt;
  ImageSize size{spec.width, spec.height, spec.get_int_attribute("Orientation", 1)};
  if (size.orientation < 1 || size.orientation > 8) size.orientation = 1;
  return size;
}

}  // namespace sfm
