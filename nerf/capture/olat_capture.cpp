#include "nerf/capture/olat_capture.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/base/text.h"
#include "nerf/capture/chrome_ball.h"
#include "nerf/capture/olat_pictures.h"
#include "nerf/image/image_io.h"
#include "nerf/image/mask.h"
#include "nerf/light/light_file.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLightNames[] = {"lights.txt", "light_directions.txt"};
constexpr const char* kChromeName = "chrome";

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
  if (!OlatPicturesIn(folder).empty()) return folder;
  std::vector<fs::path> subjects;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!entry.is_directory() || entry.path().filename() == kChromeName) continue;
    if (ContainsResults(entry.path())) continue;
    if (!OlatPicturesIn(entry.path()).empty()) subjects.push_back(entry.path());
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
  std::ranges::for_each(capture.masks, check);
}

// The file of the lights in the folder of the images or in its parent.
std::optional<fs::path> LightFileNear(const fs::path& folder) {
  for (const char* name : kLightNames) {
    if (const auto found = Near(folder, name)) return found;
  }
  for (const fs::path& place : {folder, folder.parent_path()}) {
    std::vector<fs::path> found;
    std::error_code error;
    for (fs::directory_iterator it(place, error), end; !error && it != end; it.increment(error)) {
      if (Lowercase(it->path().extension().string()) == ".lp") found.push_back(it->path());
    }
    if (found.size() == 1) return found.front();
  }
  return std::nullopt;
}

// The lights in the order of the images, from a list that names the images. The extensions may
// differ, as where raw files were developed.
std::vector<DirectionalLight> LightsByName(const LightList& list, const OlatCapture& capture,
                                           const fs::path& file) {
  std::map<std::string, std::size_t> light_of;
  for (std::size_t i = 0; i < list.images.size(); ++i) {
    const std::string stem = Lowercase(fs::path(list.images[i]).stem().string());
    if (!light_of.emplace(stem, i).second) {
      throw InputError("{}: names the image {} twice; remove one of the lines", file.string(),
                       list.images[i]);
    }
  }
  std::vector<DirectionalLight> lights;
  for (const fs::path& image : capture.images) {
    const auto found = light_of.find(Lowercase(image.stem().string()));
    if (found == light_of.end()) {
      throw InputError("{}: has no light for the image {}; add a line, or remove the image",
                       file.string(), image.filename().string());
    }
    lights.push_back(list.lights[found->second]);
  }
  return lights;
}

void FindLights(OlatCapture& capture, const fs::path& folder, const OlatOptions& options) {
  const auto found = LightFileNear(folder);
  const bool from_ball = options.lights == LightCalibration::kChromeBall ||
                         (options.lights == LightCalibration::kAuto && !found);
  if (from_ball) {
    if (!capture.chrome) {
      throw InputError(
          "{}: contains neither lights.txt, light_directions.txt or an .lp file, nor a folder "
          "\"{}\" with a chrome ball under the same lights; add one of them",
          folder.string(), kChromeName);
    }
    capture.lights = LightsFromChrome(capture, options.encoding);
    capture.lights_source = capture.chrome->string();
    return;
  }
  const fs::path file = options.lights == LightCalibration::kAuto ? *found : options.light_file;
  LightList list = ReadLights(file);
  capture.lights_source = file.string();
  if (const auto beside = Near(folder, "light_intensities.txt"); beside && !list.has_intensities) {
    spdlog::warn("{}: its intensities are not used, since the lights are from {}", beside->string(),
                 file.string());
  }
  if (!list.images.empty()) {
    capture.lights = LightsByName(list, capture, file);
    return;
  }
  if (list.lights.size() != capture.images.size()) {
    throw InputError("{}: {} lights for {} images in {}; give one for each", file.string(),
                     list.lights.size(), capture.images.size(), folder.string());
  }
  capture.lights = std::move(list.lights);
}

}  // namespace

OlatCapture FindOlatCapture(const fs::path& given, const OlatOptions& options) {
  const fs::path folder = ImageFolder(WithFolderName(given));
  OlatCapture capture;
  capture.name = folder.filename().string();
  capture.folder = given;
  OlatPictures pictures = FindOlatPictures(folder);
  capture.images = std::move(pictures.images);
  capture.masks = std::move(pictures.masks);
  if (capture.images.empty()) {
    throw InputError("{}: contains only masks (images with the word mask in their names)",
                     folder.string());
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
  const OlatPictures pictures = FindOlatPictures(folder);
  if (pictures.masks.empty()) {
    throw InputError("{}: contains no mask of the ball; add an image with \"mask\" in its name",
                     folder.string());
  }
  if (pictures.images.size() != capture.images.size()) {
    throw InputError("{}: {} images of the ball, but {} of {}; give one for each light",
                     folder.string(), pictures.images.size(), capture.images.size(), capture.name);
  }
  const fs::path& mask = pictures.masks.front();
  const BallOutline ball = FindBall(ReadMaskCoverage(mask, true), mask.string());
  std::vector<DirectionalLight> lights;
  for (const fs::path& file : pictures.images) {
    lights.push_back({LightFromHighlight(ReadLinearImage(file, encoding), ball, file.string())});
  }
  return lights;
}

}  // namespace nerf
