#include "nerf/base/ply_vertices.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <sstream>
#include <utility>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"

namespace nerf {
namespace {

static_assert(std::endian::native == std::endian::little, "values are read as they are stored");

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

}  // namespace

PlyVertices::PlyVertices(const std::filesystem::path& file)
    : file_(file.string()), bytes_(ReadWholeFile(file)) {
  constexpr std::string_view kEnd = "end_header\n";
  const std::size_t end = bytes_.find(kEnd);
  if (!bytes_.starts_with("ply\n") || end == std::string::npos) {
    Fail("is no PLY file with lines that end in LF");
  }
  begin_ = end + kEnd.size();
  ReadHeader(bytes_.substr(0, end));
  if (stride_ == 0 || static_cast<std::uint64_t>(count_) > (bytes_.size() - begin_) / stride_) {
    Fail("ends before its last vertex");
  }
}

void PlyVertices::ReadHeader(const std::string& header) {
  std::istringstream lines(header);
  bool is_vertex = false, is_binary = false;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string keyword, first, second;
    words >> keyword >> first >> second;
    if (keyword == "format") is_binary = first == "binary_little_endian";
    if (keyword == "element") {
      if (is_vertex) break;
      if (first != "vertex") Fail("has other elements before its vertices");
      is_vertex = true;
      if (!(std::istringstream(second) >> count_)) count_ = 0;
    }
    if (keyword == "property") AddProperty(first, second);
  }
  if (!is_binary) Fail("is not binary_little_endian; convert it");
  if (count_ < 1) Fail("has no vertices");
}

void PlyVertices::AddProperty(const std::string& type_name, const std::string& name) {
  const char type = TypeOf(type_name);
  if (type == 0) Fail(fmt::format("property {} has the type {}", name, type_name));
  properties_.push_back({name, type, stride_});
  stride_ += SizeOf(type);
}

void PlyVertices::Fail(const std::string& what) const { throw InputError("{}: {}", file_, what); }

const PlyProperty* PlyVertices::Find(const std::string& name) const {
  const auto found = std::ranges::find(properties_, name, &PlyProperty::name);
  return found == properties_.end() ? nullptr : &*found;
}

double PlyVertices::At(std::int64_t vertex, const PlyProperty& property) const {
  const char* const bytes =
      bytes_.data() + begin_ + static_cast<std::size_t>(vertex) * stride_ + property.offset;
  switch (property.type) {
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

}  // namespace nerf
