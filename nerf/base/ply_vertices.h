#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace nerf {

// A property of the vertices of a PLY file.
struct PlyProperty {
  std::string name;
  char type = 'f';         // see the names in the .cpp
  std::size_t offset = 0;  // bytes, in a vertex
};

// The vertices of a binary PLY file, with scalar properties of any order and type. What follows
// them is not read. Source: Greg Turk, "The PLY Polygon File Format", 1994.
class PlyVertices {
 public:
  // Throws InputError naming the file, and what is missing, damaged, or not supported: text, big
  // endian, and elements before the vertices.
  explicit PlyVertices(const std::filesystem::path& file);

  std::int64_t Count() const { return count_; }  // at least 1
  const std::vector<PlyProperty>& Properties() const { return properties_; }
  // nullptr where it is missing.
  const PlyProperty* Find(const std::string& name) const;
  double At(std::int64_t vertex, const PlyProperty& property) const;

 private:
  void ReadHeader(const std::string& header);
  void AddProperty(const std::string& type, const std::string& name);
  [[noreturn]] void Fail(const std::string& what) const;

  std::string file_;
  std::string bytes_;      // of the file
  std::size_t begin_ = 0;  // of the vertices
  std::int64_t count_ = 0;
  std::size_t stride_ = 0;  // bytes of a vertex
  std::vector<PlyProperty> properties_;
};

}  // namespace nerf
