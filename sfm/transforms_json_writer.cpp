#include <nlohmann/json.hpp>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/scene/rigid_pose.h"
#include "sfm/transforms_json.h"
#include "sfm/transforms_json_camera.h"

namespace fs = std::filesystem;

namespace nerf::sfm {
namespace {

// The relative path of an image. Resolves links of folders, since ".." in the result would follow
// them, but not that of the image itself.
std::string PathFrom(const fs::path& folder, const fs::path& image) {
  std::error_code error;
  const fs::path image_folder = fs::absolute(image).parent_path();
  const fs::path relative = fs::relative(image_folder, folder, error);
  if (error || relative.empty()) return fs::absolute(image).generic_string();
  return (relative / image.filename()).lexically_normal().generic_string();
}

nlohmann::json JsonFromPose(const Eigen::Isometry3d& world_from_camera) {
  const Eigen::Matrix4d matrix = WorldFromOpenGLCamera(world_from_camera).matrix();
  nlohmann::json rows = nlohmann::json::array();
  for (int i = 0; i < 4; ++i) {
    rows.push_back({matrix(i, 0), matrix(i, 1), matrix(i, 2), matrix(i, 3)});
  }
  return rows;
}

void AddLight(const NamedLight& light, nlohmann::json& frame) {
  const auto list = [](const auto& v) { return nlohmann::json{v[0], v[1], v[2]}; };
  if (!light.name.empty()) frame["light"] = light.name;
  if (!light.direction) return;
  frame["light_direction"] = list(*light.direction);
  frame["light_irradiance"] = list(light.irradiance);
}

const char* SplitListName(Split split) {
  switch (split) {
    case Split::kTrain:
      return "train_filenames";
    case Split::kValidation:
      return "val_filenames";
    case Split::kTest:
      return "test_filenames";
    case Split::kUnspecified:
      break;
  }
  return nullptr;
}

}  // namespace

void WriteTransformsJson(const PosedImages& posed, const fs::path& file) {
  const fs::path folder = fs::absolute(file).parent_path();
  const bool one_camera = posed.cameras.size() == 1;
  nlohmann::json root = nlohmann::json::object();
  if (one_camera) root = JsonFromCamera(posed.cameras[0]);
  nlohmann::json& frames = root["frames"] = nlohmann::json::array();
  nlohmann::json lists = nlohmann::json::object();
  for (const PosedImage& image : posed.images) {
    nlohmann::json frame = nlohmann::json::object();
    if (!one_camera) frame = JsonFromCamera(posed.cameras[image.camera]);
    frame["file_path"] = PathFrom(folder, image.path);
    if (!image.mask.empty()) frame["mask_path"] = PathFrom(folder, image.mask);
    frame["transform_matrix"] = JsonFromPose(image.world_from_camera);
    // Our own keys: the name must not change with the folder of the file, as file_path does; and
    // the size does not show a rotation that leaves it unchanged.
    if (image.name != frame["file_path"]) frame["source_name"] = image.name;
    if (image.upright_by_exif) frame["upright_by_exif"] = true;
    AddLight(image.light, frame);
    if (const char* list = SplitListName(image.split)) lists[list].push_back(frame["file_path"]);
    frames.push_back(std::move(frame));
  }
  root.update(lists);
  try {
    WriteFileAtomically(file, root.dump(2) + "\n");
  } catch (const nlohmann::json::exception&) {
    throw InputError("{}: cannot be written: the path of an image is not UTF-8; rename it",
                     file.string());
  }
}

}  // namespace nerf::sfm
