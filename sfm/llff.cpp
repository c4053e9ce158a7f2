#include "sfm/llff.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <xtensor/xarray.hpp>
#include <xtensor/xnpy.hpp>

#include "nerf/base/file_bytes.h"
#include "nerf/base/input_error.h"
#include "nerf/image/image_files.h"
#include "nerf/scene/camera_intrinsics.h"
#include "nerf/scene/rigid_pose.h"

namespace fs = std::filesystem;

namespace nerf::sfm {
namespace {

constexpr std::size_t kColumns = 17;
using PosesBounds = Eigen::Matrix<double, Eigen::Dynamic, kColumns>;

// The contents of a NumPy file that is safe to read with xtensor, which does not validate headers.
struct NpyContents {
  std::size_t rows = 0;
  bool is_double = false;
};

// Compares the header with those that fit the size of the file, without parsing it.
// Format: NumPy Enhancement Proposal 1, version 1.0.
std::optional<NpyContents> CheckNpy(std::string_view bytes) {
  constexpr std::size_t kPreamble = 10;
  if (bytes.size() < kPreamble || bytes.substr(0, 8) != std::string_view("\x93NUMPY\x01\x00", 8)) {
    return std::nullopt;
  }
  const auto length_low = static_cast<unsigned char>(bytes[8]);
  const auto length_high = static_cast<unsigned char>(bytes[9]);
  // NumPy pads to 128 bytes in total; xtensor misreads longer headers.
  if (length_low > 127 || length_high != 0 || bytes.size() < kPreamble + length_low) {
    return std::nullopt;
  }
  std::string header(bytes.substr(kPreamble, length_low));
  if (header.empty() || header.back() != '\n') return std::nullopt;
  header.pop_back();
  std::erase(header, ' ');
  const std::size_t payload = bytes.size() - kPreamble - length_low;
  for (const auto& [type, word] : {std::pair{"<f8", 8}, std::pair{"<f4", 4}}) {
    if (payload % (kColumns * word) != 0) continue;
    const std::size_t rows = payload / (kColumns * word);
    for (const char* fortran_order : {"False", "True"}) {
      if (header == fmt::format("{{'descr':'{}','fortran_order':{},'shape':({},{}),}}", type,
                                fortran_order, rows, kColumns)) {
        return NpyContents{rows, word == 8};
      }
    }
  }
  return std::nullopt;
}

template <class T>
PosesBounds LoadNpy(const std::string& bytes) {
  std::istringstream stream(bytes);
  const xt::xarray<T> array = xt::load_npy<T>(stream);
  PosesBounds rows(array.shape(0), kColumns);
  for (std::size_t i = 0; i < array.shape(0); ++i) {
    for (std::size_t j = 0; j < kColumns; ++j) rows(i, j) = array(i, j);
  }
  return rows;
}

PosesBounds ReadPosesBounds(const fs::path& file) {
  const std::string bytes = ReadFileBytes(file);
  const auto contents = CheckNpy(bytes);
  if (!contents) {
    throw InputError(
        "{}: not a complete NumPy array of shape (N, 17) in float32 or float64; copy it again, or "
        "save it again with numpy.save",
        file.string());
  }
  if (contents->rows == 0) throw InputError("{}: contains no poses", file.string());
  try {
    return contents->is_double ? LoadNpy<double>(bytes) : LoadNpy<float>(bytes);
  } catch (const std::exception& error) {
    throw InputError("{}: {}", file.string(), error.what());
  }
}

Eigen::Isometry3d WorldFromCamera(const Eigen::Matrix<double, 3, 5>& pose,
                                  const std::string& where) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topRows<3>() << pose.col(1), pose.col(0), -pose.col(2), pose.col(3);
  return RigidFromMatrix(matrix, where);
}

Camera CameraFromHeightWidthFocal(const Eigen::Vector3d& hwf, const std::string& where) {
  const double height = hwf[0], width = hwf[1], focal = hwf[2];
  constexpr double kLargest = 1 << 20;
  if (!(height >= 1 && width >= 1 && height <= kLargest && width <= kLargest && focal > 0 &&
        std::isfinite(focal))) {
    throw InputError("{}: height {}, width {} and focal length {} are no valid camera", where,
                     height, width, focal);
  }
  return {CameraModel::kSimplePinhole,
          static_cast<int>(std::lround(width)),
          static_cast<int>(std::lround(height)),
          {focal, width / 2, height / 2}};
}

int IndexOf(std::vector<Camera>& cameras, const Camera& camera) {
  const auto found = std::find(cameras.begin(), cameras.end(), camera);
  if (found != cameras.end()) return static_cast<int>(found - cameras.begin());
  cameras.push_back(camera);
  return static_cast<int>(cameras.size()) - 1;
}

}  // namespace

fs::path LlffImageFolder(const fs::path& folder) {
  std::error_code error;
  if (fs::is_directory(folder / "images", error)) return folder / "images";
  std::map<int, fs::path> reduced;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    const std::string number = name.starts_with("images_") ? name.substr(7) : "";
    if (!number.empty() && number.size() < 5 &&
        number.find_first_not_of("0123456789") == std::string::npos && fs::is_directory(*it)) {
      reduced.emplace(std::stoi(number), it->path());
    }
  }
  if (reduced.empty()) {
    throw InputError("{}: has neither a folder images nor images_N beside poses_bounds.npy",
                     folder.string());
  }
  return reduced.begin()->second;
}

PosedImages ReadLlff(const fs::path& folder) {
  PosedImages result;
  result.source = folder / "poses_bounds.npy";
  const PosesBounds rows = ReadPosesBounds(result.source);
  const fs::path image_folder = LlffImageFolder(folder);
  const std::vector<fs::path> files = ImageFilesIn(image_folder);
  if (static_cast<Eigen::Index>(files.size()) != rows.rows()) {
    throw InputError("{}: has {} poses, but {} has {} images; put exactly its images there",
                     result.source.string(), rows.rows(), image_folder.string(), files.size());
  }
  std::array<double, 2> range = {std::numeric_limits<double>::infinity(), 0};
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const fs::path& file = files[i];
    const std::string where =
        fmt::format("{}: row {} ({})", result.source.string(), i, file.filename().string());
    const Eigen::Matrix<double, kColumns, 1> row = rows.row(i);
    const Eigen::Matrix<double, 3, 5> pose =
        Eigen::Map<const Eigen::Matrix<double, 3, 5, Eigen::RowMajor>>(row.data());
    PosedImage image;
    image.name = file.filename().string();
    image.path = file;
    image.world_from_camera = WorldFromCamera(pose, where);
    const Camera camera = CameraFromHeightWidthFocal(pose.col(4), where);
    const double near = row[15], far = row[16];
    if (!(near > 0 && far >= near && std::isfinite(far))) {
      throw InputError("{}: nearest depth {} and farthest depth {} are not positive and ascending",
                       where, near, far);
    }
    range = {std::min(range[0], near), std::max(range[1], far)};
    const auto stored = ReadImageSize(file);
    if (!stored) {
      result.missing.push_back(image.name + " (not a readable image)");
      continue;
    }
    const auto fitted = FitToImage(camera, *stored);
    if (!fitted) {
      throw InputError("{}: the image is {}x{} pixels, which is no scaled copy of {}x{}", where,
                       stored->width, stored->height, camera.width, camera.height);
    }
    image.camera = IndexOf(result.cameras, fitted->camera);
    image.upright_by_exif = fitted->upright_by_exif;
    result.images.push_back(std::move(image));
  }
  if (result.images.empty()) {
    throw InputError("{}: none of its {} images can be read", image_folder.string(), files.size());
  }
  result.depth_range_in_world = range;
  return result;
}

}  // namespace nerf::sfm
