#include "sfm/film.h"
#include "tests/fuzz/fuzz_reader.h"

// An input is the film.json of a folder of frames.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path film = nerf::fuzz::WriteFile("clip.mp4", "film");
  std::filesystem::create_directories(nerf::fuzz::Folder() / "frames");
  nerf::fuzz::WriteFile("frames/film.json", {reinterpret_cast<const char*>(data), size});
  nerf::fuzz::Expect([&] { nerf::sfm::EarlierFrames(film, nerf::fuzz::Folder() / "frames", 0); });
  return 0;
}
