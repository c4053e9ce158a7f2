#include <zlib.h>

#include <cstring>

#include "nerf/train/checkpoint.h"
#include "nerf/train/model.h"
#include "tests/fuzz/fuzz_reader.h"

// The checksum keeps accidents out, not malice: here it is always right.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto crc = static_cast<std::uint32_t>(crc32_z(0, data, size));
  std::string bytes(reinterpret_cast<const char*>(data), size);
  bytes.append(reinterpret_cast<const char*>(&crc), sizeof crc);
  const auto file = nerf::fuzz::WriteFile("checkpoint.nerf", bytes);
  nerf::fuzz::Expect([&] { nerf::ModelFromCheckpoint(nerf::ReadCheckpoint(file)); });
  return 0;
}
