#include "nerf/capture/olat_pictures.h"
#include "tests/fuzz/fuzz_reader.h"

// An input is the filenames.txt of a folder of pictures under one light at a time.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::filesystem::create_directories(nerf::fuzz::Folder() / "ball");
  for (const char* name : {"ball/001.png", "ball/002.png", "ball/10.png", "ball/mask.png"}) {
    nerf::fuzz::WriteFile(name, nerf::fuzz::kImage);
  }
  nerf::fuzz::WriteFile("ball/filenames.txt", {reinterpret_cast<const char*>(data), size});
  nerf::fuzz::Expect([&] { nerf::FindOlatPictures(nerf::fuzz::Folder() / "ball"); });
  return 0;
}
