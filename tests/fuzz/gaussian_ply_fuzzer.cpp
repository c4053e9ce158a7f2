#include "nerf/splats/gaussian_ply.h"
#include "tests/fuzz/fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = nerf::fuzz::WriteFile("scene.ply", {reinterpret_cast<const char*>(data), size});
  nerf::fuzz::Expect([&] { nerf::ReadGaussianPly(file); });
  return 0;
}
