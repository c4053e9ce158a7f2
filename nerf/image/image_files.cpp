#include "nerf/image/image_files.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>
#include <system_error>

namespace fs = std::filesystem;

namespace nerf {

bool HasImageEnding(const fs::path& file) {
  // What OpenImageIO reads, but for films, volumes and textures. Which of them it can depends on
  // how it was built; a photograph that it cannot open is named and skipped.
  static constexpr std::array<std::string_view, 28> kEndings = {
      ".jpg",  ".jpeg", ".png", ".tif", ".tiff", ".exr", ".hdr", ".webp", ".bmp",  ".tga",
      ".ppm",  ".pgm",  ".pnm", ".jp2", ".j2k",  ".dpx", ".gif", ".psd",  ".heic", ".heif",
      ".avif", ".dng",  ".cr2", ".nef", ".arw",  ".orf", ".rw2", ".raf"};
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
  // An image cropped to where it has pixels is as large as its whole frame.
  if (spec.full_width <= 0 || spec.full_height <= 0) return std::nullopt;
  ImageSize size{spec.full_width, spec.full_height, spec.get_int_attribute("Orientation", 1)};
  if (size.orientation < 1 || size.orientation > 8) size.orientation = 1;
  return size;
}

}  // namespace nerf
