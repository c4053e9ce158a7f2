#include "nerf/base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "nerf/base/input_error.h"
#include "nerf/base/temporary_file.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

// Writes all bytes to a new file, and the file to disk.
bool WriteToDisk(const fs::path& path, std::string_view bytes) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) return false;
  while (!bytes.empty()) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) break;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  const bool complete = bytes.empty() && fsync(file) == 0;
  const int reason = errno;
  const bool closed = close(file) == 0;
  if (!complete) errno = reason;
  return complete && closed;
}

}  // namespace

void WriteFileAtomically(const fs::path& path, std::string_view bytes) {
  TemporaryFile file(path);
  if (!WriteToDisk(file.path(), bytes)) {
    throw InputError("{}: cannot be written ({}); free some space or choose another output folder",
                     path.string(), std::strerror(errno));
  }
  file.Keep();
  SyncFolderOf(path);
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
  RemoveAbandonedFiles(folder);
}

}  // namespace nerf
