#include "sfm/photo_folder.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <optional>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/image/image_files.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;

// Larger than the images of any camera; a header with larger values counts as damaged.
constexpr int kMaxSide = 1 << 16;
constexpr int kMaxChannels = 64;

std::string FirstLine(std::string text) {
  text.resize(std::min(text.find('\n'), text.size()));
  return text.empty() ? "cannot be decoded" : text;
}

// Reads all rows, a few at a time, so that even 100 megapixels take little memory.
bool DecodeAllRows(OIIO::ImageInput& input) {
  const OIIO::ImageSpec& spec = input.spec();
  const int rows = spec.tile_width > 0 ? spec.tile_height : 64;
  std::vector<unsigned char> pixels(static_cast<std::size_t>(spec.width) * rows * spec.nchannels);
  for (int y = spec.y; y < spec.y + spec.height; y += rows) {
    const int y_end = std::min(y + rows, spec.y + spec.height);
    const bool ok = spec.tile_width > 0
                        ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, y, y_end, 0, 1, 0,
                                           spec.nchannels, OIIO::TypeUInt8, pixels.data())
                        : input.read_scanlines(0, 0, y, y_end, 0, 0, spec.nchannels,
                                               OIIO::TypeUInt8, pixels.data());
    if (!ok) return false;
  }
  return true;
}

// Sets `photo`. Returns why the file is unusable, or nullopt.
std::optional<std::string> Decode(const fs::path& path, Photo& photo) {
  const auto input = OIIO::ImageInput::open(path.string());
  if (!input) return FirstLine(OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.width > kMaxSide || spec.height > kMaxSide ||
      spec.full_width < 1 || spec.full_height < 1 || spec.full_width > kMaxSide ||
      spec.full_height > kMaxSide || spec.nchannels < 1 || spec.nchannels > kMaxChannels ||
      spec.tile_height > kMaxSide) {
    return fmt::format("its header claims {}x{} pixels with {} channels", spec.width, spec.height,
                       spec.nchannels);
  }
  if (spec.deep) return "a deep image, which has no single colour per pixel";
  photo.name = path.filename().string();
  photo.path = path;
  photo.format = input->format_name();
  photo.width = spec.full_width;
  photo.height = spec.full_height;
  const int orientation = spec.get_int_attribute("Orientation", 1);
  photo.orientation = orientation >= 1 && orientation <= 8 ? orientation : 1;
  photo.eight_bit = spec.format == OIIO::TypeUInt8;
  const bool decoded = DecodeAllRows(*input);
  const std::string message = input->geterror();
  if (!decoded) return FirstLine(message);
  // libjpeg fills missing pixels with grey and only warns.
  if (message.find("Premature end") != std::string::npos) return "truncated";
  return std::nullopt;
}

}  // namespace

std::vector<fs::path> ListPhotos(const fs::path& folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (!fs::exists(status)) {
    throw InputError("{}: no such folder; give the folder with the photographs", folder.string());
  }
  if (!fs::is_directory(status)) {
    throw InputError("{}: is a file; give the folder with the photographs", folder.string());
  }
  std::vector<fs::path> files;
  std::string other_extension;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;  // a dangling link is no regular file
    const std::string name = it->path().filename().string();
    if (name.starts_with('.') || !it->is_regular_file(ignored)) continue;
    if (HasImageExtension(it->path())) {
      files.push_back(fs::absolute(it->path()).lexically_normal());
    } else if (it->path().has_extension()) {
      other_extension = it->path().extension().string();
    }
  }
  if (error) throw InputError("{}: cannot be listed: {}", folder.string(), error.message());
  if (files.empty()) {
    throw InputError(
        "{}: contains no photographs{}; give a folder of jpg, png, tif, exr, ... files",
        folder.string(),
        other_extension.empty() ? "" : fmt::format(" (but {} files)", other_extension));
  }
  if (files.size() == 1) {
    throw InputError("{}: contains only one photograph, {}; poses need at least two that overlap",
                     folder.string(), files[0].filename().string());
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return a.filename().string() < b.filename().string();
  });
  return files;
}

PhotoFolder CheckPhotos(const std::vector<fs::path>& files, int threads) {
  const int count = static_cast<int>(files.size());
  std::vector<Photo> photos(files.size());
  std::vector<std::optional<std::string>> reasons(files.size());
  ParallelForEach(
      count, [&](std::int64_t i) { reasons[i] = Decode(files[i], photos[i]); }, threads);

  PhotoFolder result;
  for (int i = 0; i < count; ++i) {
    if (reasons[i]) {
      result.skipped.push_back({files[i].filename().string(), *reasons[i]});
    } else {
      result.photos.push_back(std::move(photos[i]));
    }
  }
  if (result.photos.size() < 2) {
    const std::string folder = files.empty() ? "" : files[0].parent_path().string();
    const std::string first =
        result.skipped.empty()
            ? ""
            : fmt::format(" ({}: {})", result.skipped[0].name, result.skipped[0].reason);
    throw InputError(
        "{}: only {} of {} photographs can be read{}; copy them again; at least two are needed",
        folder, result.photos.size(), count, first);
  }
  return result;
}

}  // namespace nerf::sfm
