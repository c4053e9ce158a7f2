#include "sfm/photo_folder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "nerf/base/file_bytes.h"
#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/text.h"
#include "nerf/image/image_files.h"
#include "nerf/image/oiio_files.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;

// Larger than the images of any camera; a header with larger values counts as damaged.
constexpr int kMaxSide = 1 << 16;
constexpr int kMaxChannels = 64;

// The first line of a message of OpenImageIO.
std::string ReasonOf(const std::string& message) {
  return message.empty() ? "cannot be decoded" : FirstLine(message);
}

bool IsCroppedAfterExif(const OIIO::ImageSpec& spec) {
  const ImageSize exif = {spec.get_int_attribute("Exif:PixelXDimension"),
                          spec.get_int_attribute("Exif:PixelYDimension")};
  if (exif.width < 1 || exif.height < 1) return false;
  // Programs that turn a picture upright often leave the sizes as they were, and others cut off the
  // last blocks of a JPEG.
  constexpr double kTrimmed = 0.02;
  const double stored = std::log(static_cast<double>(spec.full_width) / spec.full_height);
  const double before = std::log(static_cast<double>(exif.width) / exif.height);
  return std::min(std::fabs(stored - before), std::fabs(stored + before)) > kTrimmed;
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
std::optional<std::string> Decode(const PhotoFile& file, Photo& photo) {
  const auto input = OpenImageInput(file.path);
  if (!input) return ReasonOf(OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.width > kMaxSide || spec.height > kMaxSide ||
      spec.full_width < 1 || spec.full_height < 1 || spec.full_width > kMaxSide ||
      spec.full_height > kMaxSide || spec.nchannels < 1 || spec.nchannels > kMaxChannels ||
      spec.tile_height > kMaxSide) {
    return fmt::format("its header claims {}x{} pixels with {} channels", spec.width, spec.height,
                       spec.nchannels);
  }
  if (spec.deep) return "a deep image, which has no single colour per pixel";
  photo.name = file.name;
  photo.path = file.path;
  photo.format = input->format_name();
  photo.width = spec.full_width;
  photo.height = spec.full_height;
  photo.orientation = OrientationOf(spec);
  photo.eight_bit = spec.format == OIIO::TypeUInt8;
  photo.cropped_after_exif = IsCroppedAfterExif(spec);
  const bool decoded = DecodeAllRows(*input);
  const std::string message = input->geterror();
  if (!decoded) return ReasonOf(message);
  // libjpeg fills missing pixels with grey and only warns.
  if (message.find("Premature end") != std::string::npos) return "truncated";
  return std::nullopt;
}

bool Exists(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

// Whether a sub-folder can hold photographs.
bool HoldsPhotos(const fs::path& folder) {
  static const std::set<std::string> kOthers = {"masks",  "mask",   "depth",
                                                "depths", "colmap", "sparse"};
  const std::string name = Lowercase(folder.filename().string());
  const bool is_result = std::ranges::any_of(
      std::array{"config.json", "steps.json", "film.json", "eval.json", "normals.exr", "relit.exr"},
      [&](const char* file) { return Exists(folder / file); });
  return !name.starts_with('.') && !kOthers.contains(name) && !is_result;
}

// Collects the photographs of a folder and its sub-folders, each once, whatever links lead to it.
class PhotoCollector {
 public:
  void Add(const fs::path& folder, const std::string& prefix = "") {
    std::error_code error;
    if (!visited_.insert(fs::canonical(folder, error)).second) return;
    fs::directory_iterator it(folder, error);
    for (const fs::directory_iterator end; !error && it != end; it.increment(error)) {
      std::error_code ignored;  // a dangling link is no regular file
      const fs::path& path = it->path();
      const std::string name = prefix + path.filename().string();
      if (it->is_directory(ignored)) {
        if (HoldsPhotos(path)) Add(path, name + "/");
      } else if (HasImageExtension(path) && !path.filename().string().starts_with('.') &&
                 it->is_regular_file(ignored)) {
        files.push_back({name, fs::absolute(path).lexically_normal()});
      }
    }
    if (error) throw InputError("{}: cannot be listed: {}", folder.string(), error.message());
  }

  std::vector<PhotoFile> files;

 private:
  std::set<fs::path> visited_;
};

// An extension of a file in the folder that is none of an image, for messages.
std::string OtherExtension(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    const fs::path& path = it->path();
    if (it->is_regular_file(ignored) && !path.filename().string().starts_with('.') &&
        path.has_extension() && !HasImageExtension(path)) {
      return path.extension().string();
    }
  }
  return {};
}

}  // namespace

std::vector<PhotoFile> PhotosBelow(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) return {};
  PhotoCollector collector;
  collector.Add(folder);
  std::ranges::sort(collector.files, {}, &PhotoFile::name);
  return std::move(collector.files);
}

std::vector<PhotoFile> ListPhotos(const fs::path& folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (!fs::exists(status)) {
    throw InputError("{}: no such folder; give the folder with the photographs", folder.string());
  }
  if (!fs::is_directory(status)) {
    throw InputError("{}: is a file; give the folder with the photographs", folder.string());
  }
  fs::directory_iterator(folder, error);
  if (error) throw InputError("{}: cannot be listed: {}", folder.string(), error.message());
  std::vector<PhotoFile> files = PhotosBelow(folder);
  if (files.empty()) {
    const std::string other = OtherExtension(folder);
    throw InputError(
        "{}: contains no photographs{}; give a folder of jpg, png, tif, exr, ... files",
        folder.string(), other.empty() ? "" : fmt::format(" (but {} files)", other));
  }
  if (files.size() == 1) {
    throw InputError("{}: contains only one photograph, {}; poses need at least two that overlap",
                     folder.string(), files[0].name);
  }
  return files;
}

std::string DescribeSubFolders(const std::vector<PhotoFile>& files) {
  std::map<std::string, int> count_of;
  for (const PhotoFile& file : files) ++count_of[fs::path(file.name).parent_path().string()];
  if (!count_of.contains("") || count_of.size() == 1) return {};
  std::string text;
  for (const auto& [sub_folder, count] : count_of) {
    if (!sub_folder.empty()) {
      text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", sub_folder, count);
    }
  }
  return fmt::format("photographs in sub-folders are used as well as the {} above them: {}",
                     count_of.at(""), text);
}

PhotoFolder CheckPhotos(const std::vector<PhotoFile>& files, int threads) {
  std::vector<Photo> photos(files.size());
  std::vector<std::optional<std::string>> reasons(files.size());
  ParallelForEach(
      std::ssize(files), [&](std::int64_t i) { reasons[i] = Decode(files[i], photos[i]); },
      threads);

  PhotoFolder result;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (reasons[i]) {
      result.skipped.push_back({files[i].name, *reasons[i]});
    } else {
      result.photos.push_back(std::move(photos[i]));
    }
  }
  if (result.photos.size() < 2) {
    const std::string folder = files.empty() ? "" : files[0].path.parent_path().string();
    const std::string first =
        result.skipped.empty()
            ? ""
            : fmt::format(" ({}: {})", result.skipped[0].name, result.skipped[0].reason);
    throw InputError(
        "{}: only {} of {} photographs can be read{}; copy them again; at least two are needed",
        folder, result.photos.size(), files.size(), first);
  }
  return result;
}

void SkipDuplicates(PhotoFolder& folder) {
  std::map<std::uintmax_t, int> count_of_size;
  const auto size_of = [](const Photo& photo) {
    std::error_code error;
    return fs::file_size(photo.path, error);
  };
  for (const Photo& photo : folder.photos) ++count_of_size[size_of(photo)];
  // Files of equal size are read once; whole files are compared only if their hashes agree.
  std::map<std::pair<std::uintmax_t, std::size_t>, Photo> first_of;
  std::vector<Photo> unique;
  for (Photo& photo : folder.photos) {
    const std::uintmax_t size = size_of(photo);
    if (count_of_size[size] > 1) {
      const std::string bytes = ReadFileBytes(photo.path);
      const auto [first, is_new] =
          first_of.try_emplace({size, std::hash<std::string>()(bytes)}, photo);
      if (!is_new && ReadFileBytes(first->second.path) == bytes) {
        folder.skipped.push_back({photo.name, "the same file as " + first->second.name});
        continue;
      }
    }
    unique.push_back(std::move(photo));
  }
  folder.photos = std::move(unique);
  if (folder.photos.size() < 2) {
    throw InputError("{}: its photographs are all the same file, {}; at least two are needed",
                     folder.photos[0].path.parent_path().string(), folder.photos[0].name);
  }
}

}  // namespace nerf::sfm
