#include "sfm/pose_input.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/image/image_files.h"
#include "sfm/colmap_model.h"
#include "sfm/film.h"
#include "sfm/llff.h"
#include "sfm/photo_folder.h"
#include "sfm/transforms_json.h"

namespace fs = std::filesystem;

namespace nerf::sfm {
namespace {

bool IsFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

fs::path FolderOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

std::optional<fs::path> FindColmapModel(const fs::path& input) {
  for (const fs::path& folder : {input, input / "sparse", input / "colmap" / "sparse"}) {
    if (IsColmapModel(folder)) return folder;
    if (const auto chosen = ChosenModel(folder)) return chosen;
    if (!SubModels(folder).empty()) return LargestModel(folder);
  }
  return std::nullopt;
}

// The folder that contains most of the photographs of a model.
fs::path FindColmapImages(const fs::path& input, const fs::path& model) {
  const std::vector<std::string> names = ColmapImageNames(model);
  std::vector<fs::path> projects = {input};
  // For a model folder (project/sparse/0), the photographs are beside or above it.
  fs::path above = fs::absolute(input).lexically_normal();
  if (!above.has_filename()) above = above.parent_path();
  for (int level = 0; level < 2; ++level) {
    above = above.parent_path();
    projects.push_back(above);
  }
  std::vector<fs::path> folders;
  for (const fs::path& project : projects) {
    folders.push_back(project / "images");
    folders.push_back(project);
  }
  // Data sets are often handed around with reduced photographs only.
  for (const fs::path& project : projects) {
    for (const char* name : {"images_2", "images_4", "images_8"}) folders.push_back(project / name);
  }
  fs::path best;
  std::size_t most = 0;
  for (const fs::path& folder : folders) {
    std::size_t found = 0;
    std::error_code error;
    if (!fs::is_directory(folder, error)) continue;
    for (const std::string& name : names) found += FindImageFile(folder / name) ? 1 : 0;
    if (found > most) {
      most = found;
      best = folder;
    }
  }
  if (most == 0) {
    throw InputError(
        "{}: none of the {} images of this COLMAP model was found (the first is '{}', expected in "
        "{}); put the photographs into {}, or reduced ones into images_2, images_4 or images_8 "
        "beside it",
        model.string(), names.size(), names.empty() ? "" : names[0], folders[0].string(),
        folders[0].string());
  }
  return best;
}

std::vector<fs::path> FilmsIn(const fs::path& folder) {
  std::vector<fs::path> films;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const bool hidden = it->path().filename().string().starts_with('.');
    if (!hidden && HasFilmExtension(it->path()) && IsFile(it->path())) films.push_back(it->path());
  }
  std::ranges::sort(films);
  return films;
}

InputLocation FindInFolder(const fs::path& input) {
  for (const char* name : {"transforms.json", "transforms_train.json"}) {
    if (IsFile(input / name)) return {InputKind::kTransforms, input / name, input};
  }
  if (IsFile(input / "poses_bounds.npy")) {
    return {InputKind::kLlff, input / "poses_bounds.npy", LlffImageFolder(input)};
  }
  if (const auto model = FindColmapModel(input)) {
    return {InputKind::kColmap, *model, FindColmapImages(input, *model)};
  }
  if (const auto film = FindFilm(input)) return {InputKind::kFilm, {}, *film};
  for (const fs::path& folder : {input, input / "images"}) {
    if (!ImageFilesIn(folder).empty()) return {InputKind::kPhotos, {}, folder};
  }
  for (const fs::path& folder : {input / "images", input}) {
    if (!PhotosBelow(folder).empty()) return {InputKind::kPhotos, {}, folder};
  }
  const std::vector<fs::path> films = FilmsIn(input);
  if (films.size() > 1) {
    throw InputError("{}: contains {} films; give one of them, such as {}", input.string(),
                     films.size(), films[0].string());
  }
  throw InputError(
      "{}: contains no photographs and no poses (neither transforms.json, transforms_train.json, "
      "poses_bounds.npy, a COLMAP model here, in sparse/ or in colmap/sparse/, nor image files "
      "here or below)",
      input.string());
}

}  // namespace

InputLocation FindInput(const fs::path& input) {
  std::error_code error;
  const fs::file_status status = fs::status(input, error);
  if (!fs::exists(status)) throw InputError("{}: no such file or folder", input.string());
  if (fs::is_directory(status)) return FindInFolder(input);
  if (input.extension() == ".json") {
    return {InputKind::kTransforms, input, FolderOf(input)};
  }
  if (input.filename() == "poses_bounds.npy") {
    return {InputKind::kLlff, input, LlffImageFolder(FolderOf(input))};
  }
  if (HasFilmExtension(input)) return {InputKind::kFilm, {}, input};
  throw InputError(
      "{}: not an input; give a folder of photographs, a film, a COLMAP project, an LLFF folder, "
      "or "
      "a transforms.json",
      input.string());
}

std::optional<fs::path> FindFilm(const fs::path& input) {
  std::error_code error;
  if (HasFilmExtension(input) && IsFile(input)) return input;
  const std::vector<fs::path> films =
      fs::is_directory(input, error) ? FilmsIn(input) : std::vector<fs::path>();
  // A picture beside a film is its thumbnail.
  if (films.size() == 1 && PhotosBelow(input).size() < 2) return films[0];
  return std::nullopt;
}

PosedImages ReadPosedInput(const InputLocation& location) {
  switch (location.kind) {
    case InputKind::kTransforms:
      return ReadTransformsJson(location.model);
    case InputKind::kColmap:
      return ReadColmapModel(location.model, location.images);
    case InputKind::kLlff:
      return ReadLlff(FolderOf(location.model));
    case InputKind::kPhotos:
    case InputKind::kFilm:
      break;
  }
  throw InputError("{}: {} without poses; find them first with nerf poses",
                   location.images.string(),
                   location.kind == InputKind::kFilm ? "a film" : "photographs");
}

}  // namespace nerf::sfm
