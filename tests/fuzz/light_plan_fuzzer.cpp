#include "nerf/light/light_plan.h"
#include "tests/fuzz/fuzz_reader.h"

// A lights.json.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto file = nerf::fuzz::WriteFile("lights.json", bytes);
  const auto copy = file.parent_path() / "copy.json";
  nerf::fuzz::Expect([&] {
    nerf::ReadLightPlan(file);
    nerf::CopyLightPlan(file, copy);
    nerf::ReadLightPlan(copy);
  });
  return 0;
}
