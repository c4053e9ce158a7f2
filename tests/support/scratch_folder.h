#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace nerf::test {

// A temporary folder, removed by the destructor.
class ScratchFolder {
 public:
  ScratchFolder() {
    static std::atomic<int> count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("nerf_test_" + std::to_string(getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  // Writes a file below the folder, and creates its parent folders.
  std::filesystem::path Write(const std::filesystem::path& name, std::string_view bytes) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::filesystem::remove(file);  // some file systems make overwriting slow
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }

  // Writes a grey PPM image, whatever the extension.
  std::filesystem::path WriteImage(const std::filesystem::path& name, int width, int height) const {
    const std::string header =
        "P6\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
    return Write(name, header + std::string(static_cast<std::size_t>(width) * height * 3, '\x7f'));
  }

 private:
  std::filesystem::path path_;
};

}  // namespace nerf::test
