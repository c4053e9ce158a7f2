#include "nerf/output/camera_path_json.h"
#include "tests/fuzz/fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  nerf::PosedImages images;
  images.cameras = {{nerf::CameraModel::kPinhole, 8, 6, {8, 8, 4, 3}}};
  images.images.resize(1);
  const auto file = nerf::fuzz::WriteFile("path.json", bytes);
  nerf::fuzz::Expect([&] { nerf::ReadCameraPath(file); });
  nerf::fuzz::Expect([&] { nerf::ReadCameraPath(file, 64); });
  nerf::fuzz::Expect([&] { nerf::ReadPose(file, images); });
  return 0;
}
