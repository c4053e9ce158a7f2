#include "nerf/light/light_file.h"
#include "tests/fuzz/fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto file = nerf::fuzz::WriteFile("lights.txt", bytes);
  nerf::fuzz::Expect([&] { nerf::ReadLights(file); });
  return 0;
}
