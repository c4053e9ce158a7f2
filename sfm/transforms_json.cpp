#include "sfm/transforms_json.h"

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/json_fields.h"
#include "nerf/image/image_files.h"
#include "nerf/scene/camera_intrinsics.h"
#include "nerf/scene/rigid_pose.h"
#include "sfm/transforms_json_camera.h"

namespace fs = std::filesystem;

namespace nerf::sfm {
namespace {

// The keys of nerfstudio's lists of splits; an image in several lists belongs to the first.
constexpr std::array<std::pair<const char*, Split>, 3> kSplitLists = {{
    {"train_filenames", Split::kTrain},
    {"test_filenames", Split::kTest},
    {"val_filenames", Split::kValidation},
}};

// "./train/r_0" and "train/r_0" are the same image.
std::string NameFromPath(const std::string& file_path) {
  return fs::path(file_path).lexically_normal().generic_string();
}

ScaledPose ReadPose(const JsonFields& frame) {
  const std::string where = frame.Where("transform_matrix");
  const nlohmann::json* value = frame.Array("transform_matrix");
  if (!value) throw InputError("{} is missing", where);
  ScaledPose scaled = RigidFromScaledMatrix(PoseMatrixFromJson(*value, where), where);
  scaled.pose = WorldFromOpenCVCamera(scaled.pose);
  return scaled;
}

std::optional<Eigen::Vector3d> ReadVector(const JsonFields& frame, const char* key) {
  const nlohmann::json* value = frame.Array(key);
  if (value == nullptr) return std::nullopt;
  Eigen::Vector3d vector;
  for (std::size_t k = 0; k < 3; ++k) {
    if (value->size() != 3 || !(*value)[k].is_number()) {
      throw InputError("{} must be three numbers", frame.Where(key));
    }
    vector[static_cast<int>(k)] = (*value)[k].get<double>();
  }
  return vector;
}

NamedLight ReadLight(const nlohmann::json& json, const JsonFields& frame) {
  NamedLight light;
  // Other programs may mean something else by the key.
  if (json.contains("light") && json["light"].is_string()) light.name = json["light"];
  light.direction = ReadVector(frame, "light_direction");
  if (light.direction) {
    if (light.direction->isZero() || !light.direction->allFinite()) {
      throw InputError("{} is no direction; give the vector towards the light",
                       frame.Where("light_direction"));
    }
    light.direction->normalize();
  }
  if (const auto irradiance = ReadVector(frame, "light_irradiance")) {
    if (!(irradiance->minCoeff() >= 0) || !irradiance->allFinite()) {
      throw InputError("{} must be finite and not negative", frame.Where("light_irradiance"));
    }
    light.irradiance = irradiance->array();
  }
  return light;
}

void RequireNew(std::map<std::string, std::size_t>& frame_of, const std::string& value,
                std::size_t frame, const std::string& where) {
  const auto [earlier, is_new] = frame_of.emplace(value, frame);
  if (is_new) return;
  throw InputError("{} '{}' is also that of frames[{}]; remove one of the two", where, value,
                   earlier->second);
}

// Collects the frames of one or several files.
class Reader {
 public:
  explicit Reader(AbsentImages absent) : absent_(absent) {}

  void ReadFile(const fs::path& file, Split split) {
    const nlohmann::json root = ReadJsonFile(file);
    const JsonFields fields(root, file.string() + ": ");
    const nlohmann::json* frames = fields.Array("frames");
    if (!frames || frames->empty()) {
      throw InputError("{} is missing or empty; is this a transforms.json?",
                       fields.Where("frames"));
    }
    std::map<std::string, std::size_t> frame_of_path, frame_of_name;
    for (std::size_t i = 0; i < frames->size(); ++i) {
      const JsonFields frame((*frames)[i], fmt::format("{}: frames[{}].", file.string(), i));
      const auto file_path = frame.String("file_path");
      if (!file_path || file_path->empty()) {
        throw InputError("{} is missing", frame.Where("file_path"));
      }
      const std::string path = NameFromPath(*file_path);
      // Our own key: the name of the image in the source from which this file was written.
      const std::string name = NameFromPath(frame.String("source_name").value_or(path));
      RequireNew(frame_of_path, path, i, frame.Where("file_path"));
      RequireNew(frame_of_name, name, i, frame.Where("source_name"));
      AddFrame(file, (*frames)[i], frame, fields, path, name, split);
    }
    MarkSplits(fields);
  }

  PosedImages Result(const fs::path& file) && {
    if (result_.images.empty()) {
      throw InputError(
          "{}: none of its {} images was found (the first is '{}', relative to {}); put the "
          "photographs there or fix file_path",
          file.string(), result_.missing.size(), result_.missing[0],
          file.has_parent_path() ? file.parent_path().string() : ".");
    }
    std::sort(result_.images.begin(), result_.images.end(),
              [](const PosedImage& a, const PosedImage& b) { return a.name < b.name; });
    std::sort(result_.missing.begin(), result_.missing.end());
    result_.source = file;
    AddWarnings(file.string());
    return std::move(result_);
  }

 private:
  void AddFrame(const fs::path& file, const nlohmann::json& json, const JsonFields& frame,
                const JsonFields& global, const std::string& path_in_file, const std::string& name,
                Split split) {
    PosedImage image;
    image.name = name;
    image.split = split;
    const ScaledPose scaled = ReadPose(frame);
    image.world_from_camera = scaled.pose;
    if (scaled.scale != 1) {
      ++scaled_poses_;
      scale_ = scaled.scale;
    }
    image.light = ReadLight(json, frame);
    if (const auto mask = frame.String("mask_path")) FindMask(file.parent_path() / *mask, image);
    // Already in an earlier file: train comes first, and a training image cannot be held out.
    if (!name_of_path_.emplace(path_in_file, name).second) return;
    const auto path = FindImageFile(file.parent_path() / path_in_file);
    const auto stored = path ? ReadImageSize(*path) : std::nullopt;
    if (!stored) {
      result_.missing.push_back(path ? path_in_file + " (not a readable image)" : path_in_file);
      if (absent_ == AbsentImages::kKeep) {
        image.path = file.parent_path() / path_in_file;
        image.camera = CameraIndex(CameraFromJson(frame, global, {}));
        result_.images.push_back(std::move(image));
      }
      return;
    }
    image.path = *path;
    const Camera camera = CameraFromJson(frame, global, *stored);
    const auto fitted = FitToImage(camera, *stored);
    if (!fitted) {
      throw InputError(
          "{}: the image '{}' is {}x{} pixels, which is no scaled copy of the {}x{} of w and h; "
          "fix w and h, or give the images for which the file was written",
          frame.Where("file_path"), path_in_file, stored->width, stored->height, camera.width,
          camera.height);
    }
    image.upright_by_exif = frame.Bool("upright_by_exif").value_or(fitted->upright_by_exif);
    image.camera = CameraIndex(fitted->camera);
    result_.images.push_back(std::move(image));
  }

  void FindMask(const fs::path& path, PosedImage& image) {
    if (const auto mask = FindImageFile(path)) {
      image.mask = *mask;
    } else {
      missing_masks_.push_back(path.generic_string());
    }
  }

  void AddWarnings(const std::string& file) {
    if (scaled_poses_ > 0) {
      result_.warnings.push_back(
          fmt::format("{}: the axes of {} poses have a scale of {:.4g}, which is taken out", file,
                      scaled_poses_, scale_));
    }
    if (!missing_masks_.empty()) {
      result_.warnings.push_back(
          fmt::format("{}: {} masks named by mask_path do not exist (the first: {}); their "
                      "photographs are used whole",
                      file, missing_masks_.size(), missing_masks_[0]));
    }
  }

  int CameraIndex(const Camera& camera) {
    const auto key = std::tuple(camera.model, camera.width, camera.height, camera.params);
    const auto [entry, is_new] =
        index_of_camera_.emplace(key, static_cast<int>(result_.cameras.size()));
    if (is_new) result_.cameras.push_back(camera);
    return entry->second;
  }

  void MarkSplits(const JsonFields& fields) {
    std::map<std::string, Split> split_of_name;
    for (const auto& [key, split] : kSplitLists) {
      const nlohmann::json* list = fields.Array(key);
      if (!list) continue;
      for (const nlohmann::json& entry : *list) {
        if (!entry.is_string()) throw InputError("{} must be a list of names", fields.Where(key));
        const std::string path = NameFromPath(entry.get<std::string>());
        const auto frame = name_of_path_.find(path);
        if (frame == name_of_path_.end()) {
          throw InputError("{}: no frame has the file_path '{}'", fields.Where(key), path);
        }
        split_of_name.emplace(frame->second, split);
      }
    }
    if (split_of_name.empty()) return;
    for (PosedImage& image : result_.images) {
      const auto found = split_of_name.find(image.name);
      if (found != split_of_name.end()) image.split = found->second;
    }
  }

  AbsentImages absent_;
  int scaled_poses_ = 0;
  double scale_ = 1;  // of the last of them
  std::vector<std::string> missing_masks_;
  PosedImages result_;
  std::map<std::string, std::string> name_of_path_;
  std::map<std::tuple<CameraModel, int, int, std::vector<double>>, int> index_of_camera_;
};

}  // namespace

PosedImages ReadTransformsJson(const fs::path& file, AbsentImages absent) {
  Reader reader(absent);
  if (file.filename() != "transforms_train.json") {
    reader.ReadFile(file, Split::kUnspecified);
    return std::move(reader).Result(file);
  }
  reader.ReadFile(file, Split::kTrain);
  for (const auto& [name, split] : {std::pair{"transforms_test.json", Split::kTest},
                                    std::pair{"transforms_val.json", Split::kValidation}}) {
    std::error_code error;
    const fs::path beside = file.parent_path() / name;
    if (fs::exists(beside, error)) reader.ReadFile(beside, split);
  }
  return std::move(reader).Result(file);
}

}  // namespace nerf::sfm
