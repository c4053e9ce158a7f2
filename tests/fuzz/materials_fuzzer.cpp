#include "nerf/model/materials_file.h"
#include "nerf/relight/material_edit.h"
#include "tests/fuzz/with_checksum.h"

// Materials of a run, and edits of them.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = nerf::fuzz::WriteCheckpointBytes(data, size);
  nerf::fuzz::Expect([&] { nerf::ReadMaterials(file); });
  nerf::fuzz::Expect([&] { nerf::ReadInterruptedMaterials(file); });
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto edits = nerf::fuzz::WriteFile("edits.json", bytes);
  nerf::fuzz::Expect([&] { nerf::ReadMaterialEdits(edits, {}, {{0, 0, 0}}); });
  return 0;
}
