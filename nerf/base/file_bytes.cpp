#include "nerf/base/file_bytes.h"

#include <fstream>
#include <system_error>

#include "nerf/base/input_error.h"

namespace fs = std::filesystem;

namespace nerf {

std::string ReadFileBytes(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) throw InputError("{}: no such file", file.string());
  // A pipe or a device may never end.
  if (!fs::is_regular_file(status)) throw InputError("{}: not a regular file", file.string());
  const auto size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream) {
    throw InputError("{}: cannot be read; check its permissions", file.string());
  }
  std::string bytes(size, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (stream.gcount() != static_cast<std::streamsize>(size)) {
    throw InputError("{}: reading stopped after {} of {} bytes", file.string(), stream.gcount(),
                     size);
  }
  return bytes;
}

}  // namespace nerf
