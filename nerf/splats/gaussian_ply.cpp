#include "nerf/splats/gaussian_ply.h"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
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

struct Property {
  std::string name;
  char type = 'f';
  std::size_t offset = 0;
};

// The type of a property in the file: f, d, or an integer of 1, 2 or 4 bytes; 0: unknown.
char TypeOf(const std::string& name) {
  static constexpr std::pair<const char*, char> kTypes[] = {
      {"float", 'f'}, {"float32", 'f'}, {"double", 'd'}, {"float64", 'd'},
      {"char", 'b'},  {"int8", 'b'},    {"uchar", 'B'},  {"uint8", 'B'},
      {"short", 'h'}, {"int16", 'h'},   {"ushort", 'H'}, {"uint16", 'H'},
      {"int", 'i'},   {"int32", 'i'},   {"uint", 'I'},   {"uint32", 'I'}};
  for (const auto& [known, type] : kTypes) {
    if (name == known) return type;
  }
  return 0;
}

template <class T>
double ValueAs(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

double ValueOf(char type, const char* bytes) {
  switch (type) {
    case 'f':
      return ValueAs<float>(bytes);
    case 'd':
      return ValueAs<double>(bytes);
    case 'b':
      return ValueAs<std::int8_t>(bytes);
    case 'B':
      return ValueAs<std::uint8_t>(bytes);
    case 'h':
      return ValueAs<std::int16_t>(bytes);
    case 'H':
      return ValueAs<std::uint16_t>(bytes);
    case 'i':
      return ValueAs<std::int32_t>(bytes);
    default:
      return ValueAs<std::uint32_t>(bytes);
  }
}

std::size_t SizeOf(char type) {
  switch (type) {
    case 'd':
      return 8;
    case 'b':
    case 'B':
      return 1;
    case 'h':
    case 'H':
      return 2;
    default:
      return 4;
  }
}

// What the header says of the vertices.
class Layout {
 public:
  Layout(const std::string& header, const std::string& file) : file_(file) {
    std::istringstream lines(header);
    bool is_vertex = false, is_binary = false;
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string keyword, first, second;
      words >> keyword >> first >> second;
      if (keyword == "format") is_binary = first == "binary_little_endian";
      if (keyword == "element") {
        if (is_vertex) break;  // what follows the vertices is not read
        if (first != "vertex") Fail("has other elements before its vertices");
        is_vertex = true;
        if (!(std::istringstream(second) >> count_)) count_ = 0;
      }
      if (keyword == "property") Add(first, second);
    }
    if (!is_binary) Fail("is not binary_little_endian; convert it");
    if (count_ < 1) Fail("has no vertices");
  }

  std::int64_t Count() const { return count_; }
  std::size_t Stride() const { return stride_; }
  // Throws where it is missing.
  const Property& Find(const std::string& name) const {
    const auto found = std::ranges::find(properties_, name, &Property::name);
    if (found == properties_.end()) {
      Fail(fmt::format("has no property {}, so it holds no Gaussians", name));
    }
    return *found;
  }
  int HarmonicsOrder() const {
    const auto rest = std::ranges::count_if(
        properties_, [](const Property& p) { return p.name.starts_with("f_rest_"); });
    for (int order = 0; order <= kernels::kMostHarmonicsOrder; ++order) {
      if (rest == 3 * (kernels::HarmonicsOf(order) - 1)) return order;
    }
    Fail(fmt::format("has {} properties f_rest_*; 0, 9, 24 or 45 are possible", rest));
  }
  [[noreturn]] void Fail(const std::string& what) const { throw InputError("{}: {}", file_, what); }

 private:
  void Add(const std::string& type_name, const std::string& name) {
    const char type = TypeOf(type_name);
    if (type == 0) Fail(fmt::format("property {} has the type {}", name, type_name));
    properties_.push_back({name, type, stride_});
    stride_ += SizeOf(type);
  }

  std::string file_;
  std::int64_t count_ = 0;
  std::size_t stride_ = 0;
  std::vector<Property> properties_;
};

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
  constexpr std::string_view kEnd = "end_header\n";
  const std::string bytes = ReadWholeFile(file);
  const std::size_t end = bytes.find(kEnd);
  if (!bytes.starts_with("ply\n") || end == std::string::npos) {
    throw InputError("{}: is no PLY file with lines that end in LF", file.string());
  }
  const Layout layout(bytes.substr(0, end), file.string());
  const std::size_t begin = end + kEnd.size();
  if (layout.Stride() == 0 ||
      static_cast<std::uint64_t>(layout.Count()) > (bytes.size() - begin) / layout.Stride()) {
    layout.Fail("ends before its last vertex");
  }
  const int order = layout.HarmonicsOrder();
  // Normals are optional, and not used.
  std::vector<const Property*> properties;
  for (const std::string& name : PropertyNames(order)) {
    properties.push_back(name[0] == 'n' ? nullptr : &layout.Find(name));
  }
  GaussianPly read{GaussianCloud(layout.Count(), order)};
  std::vector<double> values(properties.size(), 0.0);
  std::int64_t kept = 0;
  for (std::int64_t i = 0; i < layout.Count(); ++i) {
    const char* const vertex = bytes.data() + begin + static_cast<std::size_t>(i) * layout.Stride();
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (properties[k]) values[k] = ValueOf(properties[k]->type, vertex + properties[k]->offset);
    }
    if (SetGaussian(read.cloud, kept, values)) ++kept;
  }
  if (kept == 0) layout.Fail("none of its Gaussians is finite");
  read.left_out = layout.Count() - kept;
  std::vector<std::int64_t> first(static_cast<std::size_t>(kept));
  for (std::int64_t i = 0; i < kept; ++i) first[i] = i;
  read.cloud = Reordered(read.cloud, first);
  return read;
}

}  // namespace nerf
