#include "nerf/light/light_file.h"
#include "tests/fuzz/fuzz_reader.h"

// An input is a file of lights or, after a line "#--#", also one of intensities.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto lights = nerf::fuzz::WriteFile("lights.txt", nerf::fuzz::Part(bytes, 0));
  nerf::fuzz::Expect([&] { nerf::ReadLights(lights); });
  const auto directions = nerf::fuzz::WriteFile("light_directions.txt", nerf::fuzz::Part(bytes, 0));
  nerf::fuzz::WriteFile("light_intensities.txt", nerf::fuzz::Part(bytes, 1));
  nerf::fuzz::Expect([&] { nerf::ReadLights(directions); });
  return 0;
}
