#include "sfm/colmap_model.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/image/image_files.h"
#include "nerf/scene/camera_intrinsics.h"
#include "sfm/colmap_records.h"

namespace fs = std::filesystem;

constexpr const char* kChosen = "chosen.txt";

namespace nerf::sfm {
namespace {

struct ModelFile {
  fs::path path;
  bool binary = false;
};

std::optional<ModelFile> FindFile(const fs::path& folder, const std::string& stem) {
  std::error_code error;
  for (const bool binary : {true, false}) {
    fs::path path = folder / (stem + (binary ? ".bin" : ".txt"));
    if (fs::is_regular_file(path, error)) return ModelFile{std::move(path), binary};
  }
  return std::nullopt;
}

ModelFile RequireFile(const fs::path& folder, const std::string& stem) {
  if (auto file = FindFile(folder, stem)) return *file;
  throw InputError("{}: not a COLMAP model: there is neither {}.bin nor {}.txt", folder.string(),
                   stem, stem);
}

std::vector<colmap::ImageRecord> ReadImages(const ModelFile& file) {
  return file.binary ? colmap::ReadImagesBinary(file.path) : colmap::ReadImagesText(file.path);
}

Eigen::Isometry3d WorldFromCamera(const colmap::ImageRecord& image, const std::string& where) {
  const double norm = image.rotation.norm();
  if (!std::isfinite(norm) || !image.translation.allFinite()) {
    throw InputError("{}: the pose is not finite; remove the image from the model", where);
  }
  if (norm < 1e-12) {
    throw InputError("{}: the rotation quaternion has length zero; remove the image from the model",
                     where);
  }
  const Eigen::Vector4d q = image.rotation / norm;
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  camera_from_world.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  camera_from_world.translation() = image.translation;
  return camera_from_world.inverse();
}

// Builds PosedImages from the records of a model.
class Assembler {
 public:
  Assembler(const fs::path& model_folder, const fs::path& image_folder)
      : image_folder_(image_folder),
        cameras_file_(RequireFile(model_folder, "cameras")),
        images_file_(RequireFile(model_folder, "images")),
        points_file_(FindFile(model_folder, "points3D")) {
    result_.source = model_folder;
  }

  PosedImages Run() {
    ReadFiles();  // before the first image is opened, so that damage is reported at once
    AddImages();
    AddPoints();
    return std::move(result_);
  }

 private:
  void ReadFiles() {
    cameras_ = cameras_file_.binary ? colmap::ReadCamerasBinary(cameras_file_.path)
                                    : colmap::ReadCamerasText(cameras_file_.path);
    records_ = ReadImages(images_file_);
    if (points_file_) {
      point_records_ = points_file_->binary ? colmap::ReadPointsBinary(points_file_->path)
                                            : colmap::ReadPointsText(points_file_->path);
    }
  }

  void AddImages() {
    if (records_.empty()) {
      throw InputError("{}: no image is registered; run COLMAP again", images_file_.path.string());
    }
    std::sort(records_.begin(), records_.end(),
              [](const auto& a, const auto& b) { return a.name < b.name; });
    for (std::size_t i = 0; i < records_.size(); ++i) {
      const colmap::ImageRecord& record = records_[i];
      if (i > 0 && record.name == records_[i - 1].name) {
        throw InputError("{}: image '{}' is listed twice", images_file_.path.string(), record.name);
      }
      if (!record_of_id_.emplace(record.id, i).second) {
        throw InputError("{}: image id {} is listed twice", images_file_.path.string(), record.id);
      }
      index_of_record_.push_back(AddImage(record));
    }
    if (result_.images.empty()) {
      throw InputError(
          "{}: none of its {} images is in {} (the first: '{}'); give the folder of photographs "
          "that COLMAP used",
          images_file_.path.string(), records_.size(), image_folder_.string(), records_[0].name);
    }
  }

  // Index of the image, or nullopt where its file is missing.
  std::optional<int> AddImage(const colmap::ImageRecord& record) {
    const std::string where =
        fmt::format("{}: image '{}'", images_file_.path.string(), record.name);
    PosedImage image;
    image.name = record.name;
    image.world_from_camera = WorldFromCamera(record, where);
    const auto camera = cameras_.find(record.camera_id);
    if (camera == cameras_.end()) {
      throw InputError("{}: its camera {} is not in {}", where, record.camera_id,
                       cameras_file_.path.string());
    }
    const auto file = FindImageFile(image_folder_ / record.name);
    if (!file) {
      result_.missing.push_back(record.name);
      return std::nullopt;
    }
    image.path = *file;
    const auto stored = ReadImageSize(image.path);
    if (!stored) {
      result_.missing.push_back(record.name + " (not a readable image)");
      return std::nullopt;
    }
    const auto fitted = FitToImage(camera->second, *stored);
    if (!fitted) {
      throw InputError(
          "{}: the file is {}x{} pixels, which is no scaled copy of the {}x{} of its camera {}; "
          "give "
          "the photographs that COLMAP used",
          where, stored->width, stored->height, camera->second.width, camera->second.height,
          record.camera_id);
    }
    image.upright_by_exif = fitted->upright_by_exif;
    image.camera = CameraIndex(fitted->camera);
    result_.images.push_back(std::move(image));
    pixels_per_pixel_.emplace_back(
        static_cast<double>(fitted->camera.width) / camera->second.width,
        static_cast<double>(fitted->camera.height) / camera->second.height);
    return static_cast<int>(result_.images.size()) - 1;
  }

  int CameraIndex(const Camera& camera) {
    const auto found = std::ranges::find(result_.cameras, camera);
    if (found != result_.cameras.end()) return static_cast<int>(found - result_.cameras.begin());
    result_.cameras.push_back(camera);
    return static_cast<int>(result_.cameras.size()) - 1;
  }

  void AddPoints() {
    result_.points.reserve(point_records_.size());
    for (const colmap::PointRecord& record : point_records_) {
      if (!record.x_in_world.allFinite() || !std::isfinite(record.reprojection_error)) {
        throw InputError("{}: point {} is not finite", points_file_->path.string(), record.id);
      }
      SparsePoint& point = result_.points.emplace_back();
      point.x_in_world = record.x_in_world;
      point.rgb = record.rgb;
      point.reprojection_error = record.reprojection_error;
      for (const auto& [image_id, point2d] : record.track) {
        AddSighting(record.id, image_id, point2d, &point.track);
      }
    }
    if (stale_sightings_ > 0) {
      result_.warnings.push_back(
          fmt::format("{}: {} sightings are of images that are not in {}, and are dropped",
                      points_file_->path.string(), stale_sightings_, images_file_.path.string()));
    }
  }

  void AddSighting(std::uint64_t point_id, std::uint32_t image_id, std::uint32_t point2d,
                   std::vector<TrackElement>* track) {
    const auto record = record_of_id_.find(image_id);
    if (record == record_of_id_.end()) {  // the image was removed from the model by hand
      ++stale_sightings_;
      return;
    }
    if (point2d >= records_[record->second].points2d.size()) {
      throw InputError(
          "{}: the track of point {} names 2D point {} of image {}, which is not in {}",
          points_file_->path.string(), point_id, point2d, image_id, images_file_.path.string());
    }
    const auto image = index_of_record_[record->second];
    if (!image) return;
    const Eigen::Vector2d& pixel = records_[record->second].points2d[point2d];
    if (!pixel.allFinite()) {
      throw InputError("{}: image '{}': its 2D point {} is not finite", images_file_.path.string(),
                       records_[record->second].name, point2d);
    }
    track->push_back({*image, pixel.cwiseProduct(pixels_per_pixel_[*image])});
  }

  fs::path image_folder_;
  ModelFile cameras_file_;
  ModelFile images_file_;
  std::optional<ModelFile> points_file_;
  colmap::CameraMap cameras_;
  std::vector<colmap::ImageRecord> records_;  // by name
  std::vector<colmap::PointRecord> point_records_;
  std::unordered_map<std::uint32_t, std::size_t> record_of_id_;
  std::vector<std::optional<int>> index_of_record_;  // into result_.images
  std::vector<Eigen::Vector2d> pixels_per_pixel_;    // of the file, per pixel of the model
  std::int64_t stale_sightings_ = 0;
  PosedImages result_;
};

std::optional<int> SubModelNumber(const fs::path& folder) {
  const std::string name = folder.filename().string();
  const bool is_number = !name.empty() && name.size() <= 6 &&
                         name.find_first_not_of("0123456789") == std::string::npos;
  if (!is_number) return std::nullopt;
  return std::stoi(name);
}

}  // namespace

bool IsColmapModel(const fs::path& folder) {
  return FindFile(folder, "cameras") && FindFile(folder, "images");
}

PosedImages ReadColmapModel(const fs::path& model_folder, const fs::path& image_folder) {
  return Assembler(model_folder, image_folder).Run();
}

std::vector<std::string> ColmapImageNames(const fs::path& model_folder) {
  std::vector<std::string> names;
  for (auto& image : ReadImages(RequireFile(model_folder, "images"))) {
    names.push_back(std::move(image.name));
  }
  return names;
}

int CountRegistered(const fs::path& model_folder) {
  const ModelFile file = RequireFile(model_folder, "images");
  return file.binary ? colmap::CountImagesBinary(file.path) : colmap::CountImagesText(file.path);
}

std::vector<fs::path> SubModels(const fs::path& sparse_folder) {
  std::map<int, fs::path> by_number;
  std::error_code error;
  for (fs::directory_iterator it(sparse_folder, error), end; !error && it != end;
       it.increment(error)) {
    const auto number = SubModelNumber(it->path());
    if (number && IsColmapModel(it->path())) by_number.emplace(*number, it->path());
  }
  std::vector<fs::path> folders;
  for (auto& [number, folder] : by_number) folders.push_back(std::move(folder));
  return folders;
}

void ChooseModel(const fs::path& sparse_folder, const fs::path& model) {
  WriteFileAtomically(sparse_folder / kChosen,
                      fs::relative(model, sparse_folder).generic_string() + "\n");
}

std::optional<fs::path> ChosenModel(const fs::path& sparse_folder) {
  const fs::path file = sparse_folder / kChosen;
  if (!fs::is_regular_file(file)) return std::nullopt;
  std::string line = ReadWholeFile(file);
  line = line.substr(0, line.find('\n'));
  const fs::path model = (sparse_folder / line).lexically_normal();
  return IsColmapModel(model) ? std::optional(model) : std::nullopt;
}

fs::path LargestModel(const fs::path& sparse_folder) {
  fs::path largest;
  int most = -1;
  for (const fs::path& folder : SubModels(sparse_folder)) {
    const int registered = CountRegistered(folder);
    if (registered > most) {
      most = registered;
      largest = folder;
    }
  }
  if (most < 0) {
    throw InputError("{}: contains no COLMAP model in a folder 0, 1, ...; run COLMAP again",
                     sparse_folder.string());
  }
  return largest;
}

}  // namespace nerf::sfm
