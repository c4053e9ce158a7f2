#include "nerf/pipeline/truth_folder.h"

#include <algorithm>

#include "nerf/base/input_error.h"
#include "nerf/base/json_fields.h"
#include "nerf/image/image_files.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

// Finds the maps of lights.
class Maps {
 public:
  Maps(const fs::path& folder, const fs::path& given) {
    if (!given.empty()) places_.push_back(given);
    for (const fs::path& root : {folder, fs::absolute(folder).lexically_normal().parent_path()}) {
      for (const char* name : {"", "environments", "high_res_envmaps_2k"}) {
        places_.push_back(root / name);
      }
    }
  }

  // Throws InputError where no place has one of the names.
  fs::path Find(const std::vector<std::string>& names) const {
    for (const fs::path& place : places_) {
      for (const std::string& name : names) {
        if (fs::is_regular_file(place / name)) return place / name;
      }
    }
    throw InputError("the map {} is in none of the usual folders; name its folder with --maps",
                     names.front());
  }

 private:
  std::vector<fs::path> places_;
};

std::optional<fs::path> IfThere(const fs::path& file) {
  return fs::is_regular_file(file) ? std::optional(file) : std::nullopt;
}

TruthFolder FromTransforms(const fs::path& file, const Maps& maps) {
  const fs::path folder = file.parent_path();
  const nlohmann::json root = ReadJsonFile(file);
  const JsonFields fields(root, file.string() + ": ");
  TruthFolder truth;
  if (root.contains("lights") && root["lights"].is_object()) {
    for (const auto& item : root["lights"].items()) {
      const JsonFields light(item.value(), fields.Where("lights." + item.key()) + ".");
      const auto map = light.String("file");
      if (!map) throw InputError("{} is missing", light.Where("file"));
      const double gain = light.Number("png_exposure").value_or(1);
      if (!(gain > 0)) throw InputError("{} must be above 0", light.Where("png_exposure"));
      truth.lights[item.key()] = {maps.Find({*map}), gain};
    }
  }
  const nlohmann::json* frames = fields.Array("frames");
  for (std::size_t i = 0; frames != nullptr && i < frames->size(); ++i) {
    const nlohmann::json& json = (*frames)[i];
    const JsonFields frame(json, fmt::format("{}: frames[{}].", file.string(), i));
    const auto name = frame.String("file_path"), prefix = frame.String("gt");
    if (!name || !prefix) continue;
    TruthView view;
    view.name = fs::path(*name).lexically_normal().generic_string();
    const std::string gt = (folder / *prefix).lexically_normal().string();
    view.albedo = IfThere(gt + "_albedo.exr");
    view.normal = IfThere(gt + "_normal.exr");
    view.material = IfThere(gt + "_material.exr");
    const auto add = [&](const std::string& light, const std::string& path) {
      const auto picture = FindImageFile(folder / path);
      if (picture && truth.lights.contains(light)) view.relit[light] = *picture;
    };
    if (const auto own = frame.String("light")) add(*own, *name);
    if (json.contains("relit") && json["relit"].is_object()) {
      for (const auto& item : json["relit"].items()) {
        if (item.value().is_string()) add(item.key(), item.value().get<std::string>());
      }
    }
    truth.views.push_back(std::move(view));
  }
  return truth;
}

TruthFolder FromViewFolders(const fs::path& folder, const Maps& maps) {
  constexpr std::string_view kRelit = "rgba_";
  TruthFolder truth;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!entry.is_directory()) continue;
    TruthView view;
    view.name = entry.path().filename().string();
    view.albedo = IfThere(entry.path() / "albedo.png");
    view.normal = IfThere(entry.path() / "normal.png");
    if (!view.albedo && !view.normal) continue;
    for (const auto& file : fs::directory_iterator(entry.path())) {
      const std::string stem = file.path().stem().string();
      if (file.path().extension() != ".png" || !stem.starts_with(kRelit)) continue;
      const std::string light = stem.substr(kRelit.size());
      if (!truth.lights.contains(light)) {
        truth.lights[light] = {maps.Find({light + ".hdr", light + ".exr"}), 1};
      }
      view.relit[light] = file.path();
    }
    truth.views.push_back(std::move(view));
  }
  std::ranges::sort(truth.views, {}, &TruthView::name);
  return truth;
}

}  // namespace

TruthFolder ReadTruthFolder(const fs::path& folder, const fs::path& given) {
  if (!fs::is_directory(folder)) throw InputError("{}: is not a folder", folder.string());
  const Maps maps(folder, given);
  const fs::path transforms = folder / "transforms_test.json";
  TruthFolder truth;
  if (fs::exists(transforms)) truth = FromTransforms(transforms, maps);
  if (truth.views.empty()) truth = FromViewFolders(folder, maps);
  if (truth.views.empty()) {
    throw InputError(
        "{}: has no truth: neither transforms_test.json with frames that have gt, nor a folder for "
        "each view with albedo.png and normal.png",
        folder.string());
  }
  return truth;
}

}  // namespace nerf
