#include "nerf/base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "nerf/base/input_error.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

// Owns a file descriptor and its temporary file, which is removed unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target)
      : path_(target.string() + ".tmp" + std::to_string(getpid())),
        fd_(open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {}
  ~TemporaryFile() {
    if (fd_ >= 0) close(fd_);
    if (!renamed_) unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  bool Write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = write(fd_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
  }

  bool FlushAndRename(const fs::path& target) {
    if (fsync(fd_) != 0) return false;
    const int closed = close(fd_);
    fd_ = -1;
    if (closed != 0 || std::rename(path_.c_str(), target.c_str()) != 0) return false;
    renamed_ = true;
    return true;
  }

  bool IsOpen() const { return fd_ >= 0; }

 private:
  std::string path_;
  int fd_;
  bool renamed_ = false;
};

}  // namespace

void WriteFileAtomically(const fs::path& path, std::string_view bytes) {
  TemporaryFile file(path);
  if (!file.IsOpen() || !file.Write(bytes) || !file.FlushAndRename(path)) {
    throw InputError("{}: cannot be written ({}); free some space or choose another output folder",
                     path.string(), std::strerror(errno));
  }
}

std::string ReadWholeFile(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    throw InputError("{}: is a folder; a file was expected", path.string());
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError("{}: cannot be read ({})", path.string(), std::strerror(errno));
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad()) throw InputError("{}: cannot be read ({})", path.string(), std::strerror(errno));
  return bytes;
}

void RemoveAll(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::remove_all(path, error);
  if (error) throw InputError("{}: cannot be removed: {}", path.string(), error.message());
}

void MakeOutputFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw InputError("{}: cannot be created ({}); choose another output folder with -o",
                     folder.string(), error.message());
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw InputError("{}: cannot be written to ({}); choose another output folder with -o",
                     folder.string(), std::strerror(errno));
  }
}

}  // namespace nerf
