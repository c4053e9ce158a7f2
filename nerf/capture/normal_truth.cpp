#include "nerf/capture/normal_truth.h"

#include <matio.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/quantile.h"
#include "nerf/base/text.h"
#include "nerf/image/image_io.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

constexpr float kShortest = 0.5f, kLongest = 1.5f;  // of what counts as a normal

struct CloseMat {
  void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

bool IsMap(const matvar_t& variable) {
  const bool is_real = !variable.isComplex &&
                       (variable.class_type == MAT_C_DOUBLE || variable.class_type == MAT_C_SINGLE);
  return is_real && variable.rank == 3 && variable.dims[2] == 3 && variable.dims[0] > 0 &&
         variable.dims[1] > 0;
}

// Whether a file of this many bytes can hold the values: deflate shrinks at most 1032 times.
bool Fits(const matvar_t& variable, std::uintmax_t file_bytes) {
  constexpr double kMostShrunk = 1032;
  double bytes = variable.class_type == MAT_C_DOUBLE ? 8 : 4;
  for (int i = 0; i < 3; ++i) bytes *= static_cast<double>(variable.dims[i]);
  return bytes <= kMostShrunk * static_cast<double>(file_bytes);
}

// Whether all values were read. Normals of 0 are in the background; true ones are in every channel,
// the last of which is missing in a file that was cut.
bool IsComplete(const matvar_t& variable) {
  const std::size_t count = variable.dims[0] * variable.dims[1] * 3;
  if (!IsMap(variable) || variable.data == nullptr ||
      variable.nbytes != count * static_cast<std::size_t>(variable.data_size)) {
    return false;
  }
  const auto* const bytes = static_cast<const unsigned char*>(variable.data);
  const auto* const last_channel = bytes + 2 * (variable.nbytes / 3);
  return std::any_of(last_channel, bytes + variable.nbytes, [](unsigned char b) { return b != 0; });
}

// Columns of rows of channels, as MATLAB stores arrays.
template <class T>
Image FromColumns(const matvar_t& variable) {
  const std::size_t height = variable.dims[0], width = variable.dims[1];
  Image map(static_cast<int>(width), static_cast<int>(height), 3, ColorEncoding::kLinear);
  const auto* const values = static_cast<const T*>(variable.data);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t x = 0; x < width; ++x) {
      for (std::size_t y = 0; y < height; ++y) {
        map.pixels[3 * (y * width + x) + c] =
            static_cast<float>(values[(c * width + x) * height + y]);
      }
    }
  }
  return map;
}

Image ReadMat(const fs::path& path) {
  const std::unique_ptr<mat_t, CloseMat> file(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
  if (!file) throw InputError("{}: cannot be read as a MATLAB file", path.string());
  std::string map_name;
  for (Variable info(Mat_VarReadNextInfo(file.get())); info;
       info.reset(Mat_VarReadNextInfo(file.get()))) {
    const std::string name = info->name ? info->name : "";
    if (IsMap(*info) && (map_name.empty() || name == "Normal_gt")) map_name = name;
  }
  const Variable variable(map_name.empty() ? nullptr
                                           : Mat_VarReadInfo(file.get(), map_name.c_str()));
  if (variable && (!Fits(*variable, fs::file_size(path)) ||
                   Mat_VarReadDataAll(file.get(), variable.get()) != 0 || !IsComplete(*variable))) {
    throw InputError("{}: damaged or truncated", path.string());
  }
  if (!variable) {
    throw InputError("{}: has no variable of height x width x 3 numbers; give Normal_gt.mat",
                     path.string());
  }
  return variable->class_type == MAT_C_DOUBLE ? FromColumns<double>(*variable)
                                              : FromColumns<float>(*variable);
}

Image ReadPicture(const fs::path& path) {
  Image map = ReadStoredColors(path, false);
  if (map.encoding == ColorEncoding::kLinear) return map;
  for (float& value : map.pixels) value = 2 * value - 1;
  map.encoding = ColorEncoding::kLinear;
  return map;
}

}  // namespace

Image ReadNormalTruth(const fs::path& file) {
  Image map = Lowercase(file.extension().string()) == ".mat" ? ReadMat(file) : ReadPicture(file);
  for (std::size_t i = 0; i < map.pixels.size(); i += 3) {
    Eigen::Map<Eigen::Vector3f> normal(&map.pixels[i]);
    const float length = normal.norm();
    if (length > kShortest && length < kLongest) {
      normal /= length;
    } else {
      normal.setZero();
    }
  }
  return map;
}

NormalError CompareNormals(const Image& normal, const Image& truth, const fs::path& truth_file) {
  if (normal.width != truth.width || normal.height != truth.height) {
    throw InputError(
        "{}: is {}x{} pixels, but the images are {}x{}; give the truth of this capture",
        truth_file.string(), truth.width, truth.height, normal.width, normal.height);
  }
  std::vector<double> degrees;
  double sum = 0;
  for (std::size_t i = 0; i < normal.pixels.size(); i += 3) {
    const Eigen::Vector3d n = Eigen::Map<const Eigen::Vector3f>(&normal.pixels[i]).cast<double>();
    const Eigen::Vector3d t = Eigen::Map<const Eigen::Vector3f>(&truth.pixels[i]).cast<double>();
    if (n.isZero() || t.isZero()) continue;
    // Not the arc cosine, which is inexact for small angles.
    degrees.push_back(std::atan2(n.cross(t).norm(), n.dot(t)) * 180 / std::numbers::pi);
    sum += degrees.back();
  }
  if (degrees.empty()) {
    throw InputError("{}: has no normal where one was found; give the truth of this capture",
                     truth_file.string());
  }
  NormalError error;
  error.pixels = static_cast<int>(degrees.size());
  error.mean = sum / static_cast<double>(degrees.size());
  error.median = Median(degrees);
  return error;
}

}  // namespace nerf
