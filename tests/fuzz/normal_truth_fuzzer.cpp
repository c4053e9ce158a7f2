#include "nerf/capture/normal_truth.h"
#include "tests/fuzz/fuzz_reader.h"

// An input is a MATLAB file of true normals.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file =
      nerf::fuzz::WriteFile("Normal_gt.mat", {reinterpret_cast<const char*>(data), size});
  nerf::fuzz::Expect([&] { nerf::ReadNormalTruth(file); });
  return 0;
}
