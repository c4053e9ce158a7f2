#include "nerf/image/image_files.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>

#include "nerf/base/text.h"
#include "nerf/image/oiio_files.h"

namespace fs = std::filesystem;

namespace nerf {

namespace {

// Files that could be meant: of equal name but for upper and lower case, or with an extension more.
struct Candidates {
  std::vector<fs::path> same_name, with_extension;
};

Candidates CandidatesFor(const fs::path& path) {
  const std::string name = Lowercase(path.filename().string());
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  Candidates candidates;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code unreadable;
    const fs::path& file = it->path();
    if (!it->is_regular_file(unreadable)) continue;
    if (Lowercase(file.filename().string()) == name) {
      candidates.same_name.push_back(file);
    } else if (HasImageExtension(file) && Lowercase(file.stem().string()) == name) {
      candidates.with_extension.push_back(file);
    }
  }
  return candidates;
}

}  // namespace

bool HasImageExtension(const fs::path& file) {
  // The formats of OpenImageIO except films, volumes and textures. Which of them it reads depends
  // on how it was built; a photograph that it cannot open is reported and skipped.
  static constexpr std::array<std::string_view, 28> kExtensions = {
      ".jpg",  ".jpeg", ".png", ".tif", ".tiff", ".exr", ".hdr", ".webp", ".bmp",  ".tga",
      ".ppm",  ".pgm",  ".pnm", ".jp2", ".j2k",  ".dpx", ".gif", ".psd",  ".heic", ".heif",
      ".avif", ".dng",  ".cr2", ".nef", ".arw",  ".orf", ".rw2", ".raf"};
  const std::string extension = Lowercase(file.extension().string());
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

std::optional<fs::path> FindImageFile(const fs::path& path) {
  std::error_code error;
  if (path.native().find('\\') != std::string::npos && !fs::is_regular_file(path, error)) {
    std::string with_slashes = path.string();
    std::ranges::replace(with_slashes, '\\', '/');
    return FindImageFile(with_slashes);
  }
  for (const char* extension : {"", ".png", ".jpg", ".jpeg", ".exr"}) {
    fs::path file = path;
    file += extension;
    if (fs::is_regular_file(file, error)) return file;
  }
  Candidates candidates = CandidatesFor(path);
  if (candidates.same_name.size() == 1) return candidates.same_name[0];
  if (!candidates.same_name.empty()) return std::nullopt;
  // Of several, one whose name agrees in upper and lower case.
  const auto rank = [&path](const fs::path& file) {
    return std::tuple(file.stem() != path.filename(), file.string());
  };
  const auto best = std::ranges::min_element(candidates.with_extension, {}, rank);
  if (best == candidates.with_extension.end()) return std::nullopt;
  return *best;
}

std::optional<ImageSize> ReadImageSize(const fs::path& file) {
  const auto input = OpenImageInput(file);
  if (!input) {
    OIIO::geterror();  // cleared, else OpenImageIO prints it at exit
    return std::nullopt;
  }
  const OIIO::ImageSpec& spec = input->spec();
  // The display window: an EXR may store only a part of it.
  if (spec.full_width <= 0 || spec.full_height <= 0) return std::nullopt;
  return ImageSize{spec.full_width, spec.full_height, OrientationOf(spec)};
}

}  // namespace nerf
