#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace nerf::test {

// The bytes of a minimal camera raw file (DNG): a Bayer mosaic of 16 bits with sRGB primaries,
// black at 0 and white at 65535.
//   count  sensor value at a pixel
inline std::string TinyDng(int width, int height,
                           const std::function<std::uint16_t(int x, int y)>& count) {
  static_assert(std::endian::native == std::endian::little);
  const auto bytes = [](auto value) {
    return std::string(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const auto u16 = [&](int value) { return bytes(static_cast<std::uint16_t>(value)); };
  const auto u32 = [&](std::size_t value) { return bytes(static_cast<std::uint32_t>(value)); };
  const auto fraction = [&](int over) { return u32(static_cast<std::size_t>(over)) + u32(10000); };
  enum Type { kByte = 1, kText = 2, kShort = 3, kLong = 4, kRational = 5, kSigned = 10 };
  constexpr int kBytesOf[] = {0, 1, 1, 2, 4, 8, 0, 0, 0, 0, 8};
  std::string xyz_to_camera;
  for (const int c : {32405, -15371, -4985, -9693, 18760, 416, 556, -2040, 10572}) {
    xyz_to_camera += fraction(c);
  }
  constexpr int kStripOffset = 273;
  const auto rows = static_cast<std::size_t>(height);
  const std::size_t pixel_bytes = static_cast<std::size_t>(width) * rows * 2;
  struct Entry {
    int tag;
    Type type;
    std::string value;
  };
  std::vector<Entry> entries = {
      {254, kLong, u32(0)},                                // the main image
      {256, kLong, u32(static_cast<std::size_t>(width))},  // columns
      {257, kLong, u32(rows)},                             //
      {258, kShort, u16(16)},                              // bits per sample
      {259, kShort, u16(1)},                               // not compressed
      {262, kShort, u16(32803)},                           // colour filter array
      {271, kText, std::string("Test\0", 5)},              // maker
      {272, kText, std::string("Cam\0", 4)},               // model
      {kStripOffset, kLong, u32(0)},                       // set below
      {274, kShort, u16(1)},                               // upright
      {277, kShort, u16(1)},                               // samples per pixel
      {278, kLong, u32(rows)},                             // rows per strip
      {279, kLong, u32(pixel_bytes)},                      //
      {33421, kShort, u16(2) + u16(2)},                    // mosaic pattern size
      {33422, kByte, std::string("\0\1\1\2", 4)},          // R G / G B
      {50706, kByte, std::string("\1\4\0\0", 4)},          // DNG 1.4
      {50707, kByte, std::string("\1\1\0\0", 4)},          //
      {50708, kText, std::string("Test Cam\0", 9)},        //
      {50714, kShort, u16(0)},                             // black
      {50717, kLong, u32(65535)},                          // white
      {50721, kSigned, xyz_to_camera},                     //
      {50728, kRational, u32(1) + u32(1) + u32(1) + u32(1) + u32(1) + u32(1)},  // neutral
      {50778, kShort, u16(21)}};                                                // under D65
  const auto padded = [](const std::string& v) { return v.size() + v.size() % 2; };
  const std::size_t far_values = 8 + 2 + 12 * entries.size() + 4;
  std::size_t pixels_at = far_values;
  for (const Entry& entry : entries) {
    if (entry.value.size() > 4) pixels_at += padded(entry.value);
  }
  std::string directory = u16(static_cast<int>(entries.size()));
  std::string values;
  for (Entry& entry : entries) {
    const std::size_t count_of =
        entry.value.size() / static_cast<std::size_t>(kBytesOf[entry.type]);
    if (entry.tag == kStripOffset) entry.value = u32(pixels_at);
    directory += u16(entry.tag) + u16(entry.type) + u32(count_of);
    if (entry.value.size() <= 4) {
      directory += entry.value + std::string(4 - entry.value.size(), '\0');
    } else {
      directory += u32(far_values + values.size());
      values += entry.value + std::string(padded(entry.value) - entry.value.size(), '\0');
    }
  }
  std::string file = std::string("II*\0", 4) + u32(8) + directory + u32(0) + values;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) file += bytes(count(x, y));
  }
  return file;
}

}  // namespace nerf::test
