#include "nerf/base/checkpoint_file.h"
#include "tests/fuzz/with_checksum.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = nerf::fuzz::WriteCheckpointBytes(data, size);
  nerf::fuzz::Expect([&] { nerf::CheckpointFile{file}; });
  return 0;
}
