#include "sfm/colmap_model.h"
#include "tests/fuzz/fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  nerf::fuzz::WriteFile("cameras.bin", nerf::fuzz::Part(bytes, 0));
  nerf::fuzz::WriteFile("images.bin", nerf::fuzz::Part(bytes, 1));
  nerf::fuzz::WriteFile("points3D.bin", nerf::fuzz::Part(bytes, 2));
  nerf::fuzz::WriteFile("a.ppm", nerf::fuzz::kImage);
  nerf::fuzz::Expect(
      [] { nerf::sfm::ReadColmapModel(nerf::fuzz::Folder(), nerf::fuzz::Folder()); });
  nerf::fuzz::Expect([] { nerf::sfm::CountRegistered(nerf::fuzz::Folder()); });
  return 0;
}
