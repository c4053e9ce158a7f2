#include "nerf/splats/gaussian_ply.h"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/ply_vertices.h"
#include "nerf/splats/harmonics_rotation.h"

namespace nerf {
namespace {

static_assert(std::endian::native == std::endian::little, "the header says little endian");

constexpr double kMostStoredOpacity = 0.9999;  // of files, before it is brought below kMostOpacity

// The names of the values of a Gaussian, as the reference orders them.
std::vector<std::string> PropertyNames(int order) {
  std::vector<std::string> names = {"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"};
  for (int k = 0; k < 3 * (kernels::HarmonicsOf(order) - 1); ++k) {
    names.push_back(fmt::format("f_rest_{}", k));
  }
  names.emplace_back("opacity");
  for (int k = 0; k < 3; ++k) names.push_back(fmt::format("scale_{}", k));
  for (int k = 0; k < 4; ++k) names.push_back(fmt::format("rot_{}", k));
  return names;
}

double Sigmoid(double x) { return 1 / (1 + std::exp(-x)); }
double Logit(double p) { return std::log(p / (1 - p)); }

int HarmonicsOrderOf(const PlyVertices& vertices, const std::filesystem::path& file) {
  const auto rest = std::ranges::count_if(
      vertices.Properties(), [](const PlyProperty& p) { return p.name.starts_with("f_rest_"); });
  for (int order = 0; order <= kernels::kMostHarmonicsOrder; ++order) {
    if (rest == 3 * (kernels::HarmonicsOf(order) - 1)) return order;
  }
  throw InputError("{}: has {} properties f_rest_*; 0, 9, 24 or 45 are possible", file.string(),
                   rest);
}

// Those that PropertyNames has; nullptr for normals, which are optional and not used.
std::vector<const PlyProperty*> PropertiesOf(const PlyVertices& vertices, int order,
                                             const std::filesystem::path& file) {
  std::vector<const PlyProperty*> properties;
  for (const std::string& name : PropertyNames(order)) {
    properties.push_back(name[0] == 'n' ? nullptr : vertices.Find(name));
    if (name[0] != 'n' && properties.back() == nullptr) {
      throw InputError("{}: has no property {}, so it holds no Gaussians", file.string(), name);
    }
  }
  return properties;
}

// Writes the values of a vertex, in the order of PropertyNames; false where one is not finite.
bool SetGaussian(GaussianCloud& cloud, std::int64_t i, const std::vector<double>& v) {
  if (!std::ranges::all_of(v, [](double value) { return std::abs(value) < 1e30; })) return false;
  const int rest = kernels::HarmonicsOf(cloud.order) - 1;
  const auto set = [&](int row, double value) { cloud.At(i, row) = static_cast<float>(value); };
  const std::size_t opacity = 9 + 3 * static_cast<std::size_t>(rest);
  for (int k = 0; k < 3; ++k) {
    set(kernels::kMeanRow + k, v[k]);
    set(kernels::kColorRow + k, v[6 + k]);
    for (int h = 0; h < rest; ++h) {
      set(kernels::kColorRow + 3 * (h + 1) + k, v[9 + k * rest + h]);
    }
    set(kernels::kLogScaleRow + k, v[opacity + 1 + k]);
  }
  for (int k = 0; k < 4; ++k) set(kernels::kRotationRow + k, v[opacity + 4 + k]);
  const double alpha = std::min(Sigmoid(v[opacity]), kMostStoredOpacity * kernels::kMostOpacity);
  set(kernels::kOpacityRow, Logit(std::max(alpha, 1e-12) / kernels::kMostOpacity));
  return true;
}

}  // namespace

std::int64_t BytesInPly(int harmonics_order) {
  return static_cast<std::int64_t>(sizeof(float) * PropertyNames(harmonics_order).size());
}

void WriteGaussianPly(const std::filesystem::path& file, const GaussianCloud& cloud,
                      const SceneNormalization& normalized_from_world) {
  const int rest = kernels::HarmonicsOf(cloud.order) - 1;
  std::string bytes =
      fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", cloud.count);
  for (const std::string& name : PropertyNames(cloud.order)) {
    bytes += "property float " + name + "\n";
  }
  bytes += "end_header\n";
  const auto append = [&](double value) {
    const auto single = static_cast<float>(value);
    bytes.append(reinterpret_cast<const char*>(&single), sizeof(single));
  };
  const Eigen::Matrix3d& rotation = normalized_from_world.rotation;
  const Eigen::MatrixXd turned = HarmonicsRotation(cloud.order, rotation);
  const Eigen::Quaterniond world_from_normalized(Eigen::Matrix3d(rotation.transpose()));
  Eigen::MatrixXd harmonics(rest + 1, 3);
  for (std::int64_t i = 0; i < cloud.count; ++i) {
    const auto at = [&](int row) { return static_cast<double>(cloud.At(i, row)); };
    const Eigen::Vector3d mean = normalized_from_world.WorldFromNormalized(
        {at(kernels::kMeanRow), at(kernels::kMeanRow + 1), at(kernels::kMeanRow + 2)});
    for (int k = 0; k < 3; ++k) append(mean[k]);
    for (int k = 0; k < 3; ++k) append(0);
    for (int h = 0; h <= rest; ++h) {
      for (int k = 0; k < 3; ++k) harmonics(h, k) = at(kernels::kColorRow + 3 * h + k);
    }
    const Eigen::MatrixXd in_world = turned * harmonics;
    for (int k = 0; k < 3; ++k) append(in_world(0, k));
    for (int k = 0; k < 3; ++k) {
      for (int h = 1; h <= rest; ++h) append(in_world(h, k));
    }
    append(Logit(kernels::kMostOpacity * Sigmoid(at(kernels::kOpacityRow))));
    for (int k = 0; k < 3; ++k) {
      append(at(kernels::kLogScaleRow + k) - std::log(normalized_from_world.scale));
    }
    Eigen::Quaterniond axes(at(kernels::kRotationRow), at(kernels::kRotationRow + 1),
                            at(kernels::kRotationRow + 2), at(kernels::kRotationRow + 3));
    axes = axes.norm() > 0 ? axes.normalized() : Eigen::Quaterniond::Identity();
    axes = world_from_normalized * axes;
    for (const double q : {axes.w(), axes.x(), axes.y(), axes.z()}) append(q);
  }
  WriteFileAtomically(file, bytes);
}

GaussianPly ReadGaussianPly(const std::filesystem::path& file) {
  const PlyVertices vertices(file);
  const int order = HarmonicsOrderOf(vertices, file);
  const std::vector<const PlyProperty*> properties = PropertiesOf(vertices, order, file);
  GaussianPly read{GaussianCloud(vertices.Count(), order)};
  std::vector<double> values(properties.size(), 0.0);
  std::int64_t kept = 0;
  for (std::int64_t i = 0; i < vertices.Count(); ++i) {
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (properties[k]) values[k] = vertices.At(i, *properties[k]);
    }
    if (SetGaussian(read.cloud, kept, values)) ++kept;
  }
  if (kept == 0) throw InputError("{}: none of its Gaussians is finite", file.string());
  read.left_out = vertices.Count() - kept;
  std::vector<std::int64_t> first(static_cast<std::size_t>(kept));
  for (std::int64_t i = 0; i < kept; ++i) first[i] = i;
  read.cloud = Reordered(read.cloud, first);
  return read;
}

}  // namespace nerf
