#include "nerf/model/checkpoint.h"
#include "nerf/model/gaussian_model.h"
#include "nerf/model/model.h"
#include "tests/fuzz/with_checksum.h"

// From the file to a model.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = nerf::fuzz::WriteCheckpointBytes(data, size);
  nerf::fuzz::Expect([&] { nerf::ModelFromCheckpoint(nerf::ReadCheckpoint(file)); });
  nerf::fuzz::Expect([&] { nerf::ReadInterruptedFit(file); });
  return 0;
}
