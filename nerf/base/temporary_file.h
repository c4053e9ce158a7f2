#pragma once

#include <filesystem>

namespace nerf {

// A name beside a file that is about to be written, so that the file appears whole or not at all:
// write to path(), close, then Keep(). Without Keep() the destructor removes what was written.
// The ending is that of the final name, as it tells encoders the format.
class TemporaryFile {
 public:
  // Throws InputError where the folder of `final_path` does not exist.
  explicit TemporaryFile(std::filesystem::path final_path);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

  // Gives the file its final name, in one step, replacing what stood there.
  // Throws InputError naming the final path.
  void Keep();

 private:
  std::filesystem::path final_path_;
  std::filesystem::path path_;
};

}  // namespace nerf
