#pragma once

#include <zlib.h>

#include <string>

#include "tests/fuzz/fuzz_reader.h"

namespace nerf::fuzz {

// The checksum keeps accidents out, not malice: here it is always right.
inline std::filesystem::path WriteCheckpointBytes(const std::uint8_t* data, std::size_t size) {
  const auto crc = static_cast<std::uint32_t>(crc32_z(0, data, size));
  std::string bytes(reinterpret_cast<const char*>(data), size);
  bytes.append(reinterpret_cast<const char*>(&crc), sizeof crc);
  return WriteFile("checkpoint.nerf", bytes);
}

}  // namespace nerf::fuzz
