#include "sfm/transforms_json.h"
#include "tests/fuzz/fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  nerf::fuzz::WriteFile("a.ppm", nerf::fuzz::kImage);
  const auto file = nerf::fuzz::WriteFile("transforms.json", bytes);
  nerf::fuzz::Expect([&] { nerf::sfm::ReadTransformsJson(file); });
  nerf::fuzz::Expect([&] { nerf::sfm::ReadTransformsJson(file, nerf::sfm::AbsentImages::kKeep); });
  return 0;
}
