#include "nerf/base/temporary_file.h"

#include <unistd.h>

#include <atomic>
#include <system_error>
#include <utility>

#include "nerf/base/input_error.h"

namespace nerf {
namespace fs = std::filesystem;

namespace {

// A name that no other writer uses, in this process or another one.
fs::path NameBeside(const fs::path& path) {
  static std::atomic<int> counter{0};
  return path.parent_path() / fmt::format(".{}.{}-{}{}", path.stem().string(), ::getpid(),
                                          counter++, path.extension().string());
}

}  // namespace

TemporaryFile::TemporaryFile(fs::path final_path)
    : final_path_(std::move(final_path)), path_(NameBeside(final_path_)) {
  const fs::path folder = final_path_.has_parent_path() ? final_path_.parent_path() : ".";
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    throw InputError("{}: cannot be written, the folder {} does not exist", final_path_.string(),
                     folder.string());
  }
}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  fs::remove(path_, ignored);
}

void TemporaryFile::Keep() {
  std::error_code error;
  fs::rename(path_, final_path_, error);
  if (error) {
    throw InputError("{}: cannot be written: {}", final_path_.string(), error.message());
  }
}

}  // namespace nerf
