#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "nerf/base/input_error.h"

// What every fuzz target is made of: the bytes of a hostile file, put where its reader looks.
namespace nerf::fuzz {

// A folder of this process, in memory where there is such a place.
inline const std::filesystem::path& Folder() {
  static const std::filesystem::path folder = [] {
    const std::filesystem::path memory = "/dev/shm";
    const auto base =
        std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
    const auto path = base / ("nerf_fuzz_" + std::to_string(getpid()));
    std::filesystem::create_directories(path);
    std::atexit([] { std::filesystem::remove_all(Folder()); });
    return path;
  }();
  return folder;
}

inline std::filesystem::path WriteFile(const std::filesystem::path& name, std::string_view bytes) {
  const std::filesystem::path path = Folder() / name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

// An image of 8 x 6 pixels, for what names one: PPM, which needs no more than its header and bytes.
inline const std::string kImage = "P6\n8 6\n255\n" + std::string(8 * 6 * 3, '\x7f');

// Of an input that stands for several files: what lies between its lines "#--#".
inline std::string Part(std::string_view bytes, int index) {
  constexpr std::string_view kBetween = "\n#--#\n";
  for (; index > 0; --index) {
    const std::size_t at = bytes.find(kBetween);
    if (at == std::string_view::npos) return "";
    bytes.remove_prefix(at + kBetween.size());
  }
  return std::string(bytes.substr(0, bytes.find(kBetween)));
}

// Calls a reader. It may return, or refuse; every other exception is a finding, and so are crashes,
// hangs and large allocations, which libFuzzer and the sanitizers see.
template <class Read>
void Expect(const Read& read) {
  try {
    read();
  } catch (const InputError&) {
  }
}

}  // namespace nerf::fuzz

// The name that libFuzzer calls, and the test that replays the corpus.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
