#include "nerf/capture/olat_capture.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <utility>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/capture/chrome_ball.h"
#include "nerf/image/image_files.h"
#include "nerf/image/image_io.h"
#include "nerf/image/mask.h"
#include "nerf/light/light_file.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLightsName = "lights.txt";
constexpr const char* kChromeName = "chrome";

bool IsMask(const fs::path& file) { return file.stem().string().find("mask") != std::string::npos; }

// Natural order: numbers in names are compared by value, so that "cat.2.tga" is before
// "cat.10.tga".
bool NaturalLess(const fs::path& left, const fs::path& right) {
  const std::string a = left.filename().string();
  const std::string b = right.filename().string();
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    const auto number = [&](const std::string& text, std::size_t& at) {
      const std::size_t begin = text.find_first_not_of('0', at);
      while (at < text.size() && is_digit(text[at])) ++at;
      return begin < at ? text.substr(begin, at - begin) : std::string();
    };
    const std::string m = number(a, i);
    const std::string n = number(b, j);
    if (m != n) return m.size() != n.size() ? m.size() < n.size() : m < n;
  }
  return std::pair(a.size() - i, a) < std::pair(b.size() - j, b);
}

std::vector<fs::path> PicturesIn(const fs::path& folder) {
  std::vector<fs::path> files = ImageFilesIn(folder);
  std::ranges::sort(files, NaturalLess);
  return files;
}

// Reads the list NAME.txt of the images in the folder NAME, in order.
std::vector<fs::path> ReadImageList(const fs::path& list, const fs::path& folder) {
  std::istringstream text(ReadWholeFile(list));
  std::vector<fs::path> files;
  for (std::string line; std::getline(text, line);) {
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.pop_back();
    if (!HasImageExtension(line)) continue;  // the first line counts them
    files.push_back(folder / fs::path(line).filename());
    if (!fs::exists(files.back())) {
      throw InputError("{}: lists {}, which does not exist in {}", list.string(), line,
                       folder.string());
    }
  }
  return files;
}

struct Pictures {
  std::vector<fs::path> images;
  std::optional<fs::path> mask;
};

Pictures FindPictures(const fs::path& folder) {
  const fs::path list = folder.parent_path() / (folder.filename().string() + ".txt");
  std::vector<fs::path> files;
  if (fs::is_regular_file(list)) files = ReadImageList(list, folder);
  if (files.empty()) files = PicturesIn(folder);
  Pictures pictures;
  for (fs::path& file : files) {
    if (IsMask(file)) {
      pictures.mask = std::move(file);
    } else {
      pictures.images.push_back(std::move(file));
    }
  }
  return pictures;
}

// The path of a folder with its name as the last part, for "vase/" and "." as well.
fs::path WithFolderName(const fs::path& folder) {
  const auto without_slash = [](const fs::path& path) {
    return path.has_filename() ? path : path.parent_path();
  };
  const fs::path path = without_slash(folder.lexically_normal());
  const bool has_name = !path.empty() && path != "." && path.filename() != "..";
  return has_name ? path : without_slash(fs::absolute(folder).lexically_normal());
}

// Whether a folder contains the output of photometric stereo or relighting, which is no input.
bool ContainsResults(const fs::path& folder) {
  return fs::exists(folder / "normals.exr") || fs::exists(folder / "relit.exr");
}

// The folder itself, or its only sub-folder of images other than a chrome ball and results.
fs::path ImageFolder(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw InputError("{}: no such folder; give one with an image for each light", folder.string());
  }
  if (!PicturesIn(folder).empty()) return folder;
  std::vector<fs::path> subjects;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!entry.is_directory() || entry.path().filename() == kChromeName) continue;
    if (ContainsResults(entry.path())) continue;
    if (!PicturesIn(entry.path()).empty()) subjects.push_back(entry.path());
  }
  if (subjects.empty()) {
    throw InputError("{}: contains no images; give a folder with one for each light",
                     folder.string());
  }
  std::ranges::sort(subjects);
  if (subjects.size() > 1) {
    throw InputError("{}: contains {} subjects; give one of them, e.g. {}", folder.string(),
                     subjects.size(), subjects.front().string());
  }
  return subjects.front();
}

// The path of `name` in the folder of the images or in its parent.
std::optional<fs::path> Near(const fs::path& folder, const char* name) {
  for (const fs::path& place : {folder / name, folder.parent_path() / name}) {
    if (fs::exists(place)) return place;
  }
  return std::nullopt;
}

void CheckSizes(OlatCapture& capture) {
  const auto check = [&](const fs::path& file) {
    const ImageSize header = ReadImageHeader(file);
    const auto [width, height, _] = Upright(header);
    if (capture.width == 0) capture.width = width, capture.height = height;
    if (width == capture.width && height == capture.height) return;
    throw InputError("{}: {} x {} pixels, but {} has {} x {}; all images must have the same size",
                     file.string(), width, height, capture.images.front().string(), capture.width,
                     capture.height);
  };
  std::ranges::for_each(capture.images, check);
  if (capture.mask) check(*capture.mask);
}

void FindLights(OlatCapture& capture, const fs::path& folder, const OlatOptions& options) {
  const auto found = Near(folder, kLightsName);
  const bool from_ball = options.lights == LightCalibration::kChromeBall ||
                         (options.lights == LightCalibration::kAuto && !found);
  if (from_ball) {
    if (!capture.chrome) {
      throw InputError(
          "{}: contains neither {} nor a folder \"{}\" with a chrome ball under the same lights; "
          "add one of them",
          folder.string(), kLightsName, kChromeName);
    }
    capture.lights = LightsFromChrome(capture, options.encoding);
    capture.lights_source = capture.chrome->string();
    return;
  }
  const fs::path file = options.lights == LightCalibration::kAuto ? *found : options.light_file;
  capture.lights = ReadLights(file);
  capture.lights_source = file.string();
  if (capture.lights.size() != capture.images.size()) {
    throw InputError("{}: {} lights for {} images in {}; give one for each", file.string(),
                     capture.lights.size(), capture.images.size(), folder.string());
  }
}

}  // namespace

OlatCapture FindOlatCapture(const fs::path& given, const OlatOptions& options) {
  const fs::path folder = ImageFolder(WithFolderName(given));
  OlatCapture capture;
  capture.name = folder.filename().string();
  capture.folder = given;
  Pictures pictures = FindPictures(folder);
  capture.images = std::move(pictures.images);
  capture.mask = std::move(pictures.mask);
  if (capture.images.empty()) {
    throw InputError("{}: contains a mask but no images", folder.string());
  }
  const auto chrome = Near(folder, kChromeName);
  if (chrome && fs::is_directory(*chrome) && *chrome != folder) capture.chrome = chrome;
  CheckSizes(capture);
  FindLights(capture, folder, options);
  return capture;
}

void CheckOutputFolder(const OlatCapture& capture, const fs::path& output) {
  if (!fs::exists(output)) return;
  std::vector<fs::path> input_folders = {capture.folder, capture.images.front().parent_path()};
  if (capture.chrome) input_folders.push_back(*capture.chrome);
  for (const fs::path& folder : input_folders) {
    if (!fs::equivalent(output, folder)) continue;
    throw InputError("--output {}: is part of the capture; choose another folder", output.string());
  }
}

std::vector<DirectionalLight> LightsFromChrome(const OlatCapture& capture, InputEncoding encoding) {
  const fs::path& folder = *capture.chrome;
  const Pictures pictures = FindPictures(folder);
  if (!pictures.mask) {
    throw InputError("{}: contains no mask of the ball; add an image with \"mask\" in its name",
                     folder.string());
  }
  if (pictures.images.size() != capture.images.size()) {
    throw InputError("{}: {} images of the ball, but {} of {}; give one for each light",
                     folder.string(), pictures.images.size(), capture.images.size(), capture.name);
  }
  const BallOutline ball =
      FindBall(ReadMaskCoverage(*pictures.mask, true), pictures.mask->string());
  std::vector<DirectionalLight> lights;
  for (const fs::path& file : pictures.images) {
    lights.push_back({LightFromHighlight(ReadLinearImage(file, encoding), ball, file.string())});
  }
  return lights;
}

}  // namespace nerf
