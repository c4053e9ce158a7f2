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

bool HasImageExtension(const fs::path& file) {
  // The formats of OpenImageIO except films, volumes and textures. Which of them it reads depends
  // on how it was built; a photograph that it cannot open is reported and skipped.
  static constexpr std::array<std::string_view, 28> kExtensions = {
      ".jpg",  ".jpeg", ".png", ".tif", ".tiff", ".exr", ".hdr", ".webp", ".bmp",  ".tga",
      ".ppm",  ".pgm",  ".pnm", ".jp2", ".j2k",  ".dpx", ".gif", ".psd",  ".heic", ".heif",
      ".avif", ".dng",  ".cr2", ".nef", ".arw",  ".orf", ".rw2", ".raf"};
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

std::vector<fs::path> ImageFilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const fs::path& file = it->path();
    std::error_code unreadable;
    if (HasImageExtension(file) && file.filename().string().front() != '.' &&
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
    OIIO::geterror();  // cleared, else OpenImageIO prints it at exit
    return std::nullopt;
  }
  const OIIO::ImageSpec& spec = input->spec();
  // The display window: an EXR may store only a part of it.
  if (spec.full_width <= 0 || spec.full_height <= 0) return std::nullopt;
  ImageSize size{spec.full_width, spec.full_height, spec.get_int_attribute("Orientation", 1)};
  if (size.orientation < 1 || size.orientation > 8) size.orientation = 1;
  return size;
}

}  // namespace nerf
