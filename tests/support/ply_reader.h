#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/geometry/mesh.h"

namespace nerf::test {

// Reads a binary little-endian PLY file of float positions, optional byte colours and triangles, by
// its header. Content that it cannot read fails the test.
inline Mesh ReadPly(const std::filesystem::path& file) {
  const std::string bytes = ReadWholeFile(file);
  const std::string end = "end_header\n";
  const std::size_t data = bytes.find(end);
  if (data == std::string::npos) {
    ADD_FAILURE() << "the header has no end";
    return {};
  }
  std::istringstream header(bytes.substr(0, data));
  std::size_t vertices = 0, faces = 0;
  std::vector<std::string> properties;
  std::string line, word;
  std::getline(header, line);
  EXPECT_EQ(line, "ply");
  std::getline(header, line);
  EXPECT_EQ(line, "format binary_little_endian 1.0");
  std::string element;
  while (header >> word) {
    if (word == "element") {
      header >> element;
      header >> (element == "vertex" ? vertices : faces);
    } else if (word == "property" && element == "vertex") {
      std::string type, name;
      header >> type >> name;
      properties.push_back(type + " " + name);
    } else {
      std::getline(header, line);
      EXPECT_EQ(line, " list uchar int vertex_indices");
    }
  }
  const std::vector<std::string> position = {"float x", "float y", "float z"};
  std::vector<std::string> with_color = position;
  for (const char* channel : {"uchar red", "uchar green", "uchar blue"}) {
    with_color.emplace_back(channel);
  }
  EXPECT_TRUE(properties == position || properties == with_color);

  Mesh mesh;
  std::size_t at = data + end.size();
  const auto read = [&](auto* values, std::size_t count) {
    const std::size_t size = count * sizeof *values;
    if (at + size > bytes.size()) {
      ADD_FAILURE() << "the file ends at " << bytes.size();
      return;
    }
    std::memcpy(values, bytes.data() + at, size);
    at += size;
  };
  for (std::size_t i = 0; i < vertices; ++i) {
    read(mesh.vertices.emplace_back().data(), 3);
    if (properties.size() == 6) read(mesh.colors.emplace_back().data(), 3);
  }
  for (std::size_t i = 0; i < faces; ++i) {
    std::uint8_t corners = 0;
    read(&corners, 1);
    EXPECT_EQ(corners, 3);
    read(mesh.faces.emplace_back().data(), 3);
  }
  EXPECT_EQ(at, bytes.size());
  return mesh;
}

}  // namespace nerf::test
