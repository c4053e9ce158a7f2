#include "nerf/config/config.h"
#include "tests/fuzz/fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto file = nerf::fuzz::WriteFile("config.json", bytes);
  nerf::fuzz::Expect([&] { nerf::LoadConfig(file.string(), {}); });
  nerf::fuzz::Expect([&] { nerf::LoadConfig("base", {std::string(bytes)}); });
  return 0;
}
