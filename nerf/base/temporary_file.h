#pragma once

#include <filesystem>

namespace nerf {

// A temporary file beside its final path, for writers that need a file name: write to path(),
// close, then Keep(), so that the final file is never incomplete. Without Keep() the destructor
// removes the temporary file. Its extension is that of the final name, from which encoders infer
// the format.
class TemporaryFile {
 public:
  // Throws InputError where the folder of `final_path` does not exist.
  explicit TemporaryFile(std::filesystem::path final_path);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

  // Renames the file to its final name atomically, replacing an existing file.
  // Throws InputError naming the final path.
  void Keep();

 private:
  std::filesystem::path final_path_;
  std::filesystem::path path_;
};

// Makes a renamed file survive a power failure: writes the entry in its folder to disk.
void SyncFolderOf(const std::filesystem::path& file);

// Removes the temporary files in a folder whose writers were killed: those of this machine whose
// process does not run any more.
void RemoveAbandonedFiles(const std::filesystem::path& folder);

}  // namespace nerf
