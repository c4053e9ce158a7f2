#include "nerf/base/temporary_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <regex>
#include <string>
#include <system_error>
#include <utility>

#include "nerf/base/input_error.h"

namespace nerf {
namespace fs = std::filesystem;

namespace {

fs::path FolderOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

// The name of this machine, as part of file names.
std::string HostName() {
  std::array<char, 65> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "unknown";
  std::string host = name.data();
  for (char& c : host) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return host;
}

// A name that no other writer uses, in this process, another one, or on another machine.
fs::path NameBeside(const fs::path& path) {
  static std::atomic<int> counter{0};
  return path.parent_path() / fmt::format(".{}.tmp-{}-{}-{}{}", path.stem().string(), HostName(),
                                          ::getpid(), counter++, path.extension().string());
}

bool IsRunning(const std::string& process) {
  const int id = std::atoi(process.c_str());
  return id <= 0 || kill(id, 0) == 0 || errno != ESRCH;
}

// The process that made a temporary file on this machine; empty for other files.
std::string WriterOf(const std::string& name) {
  static const std::regex ours(R"(\..*\.tmp-(.+)-(\d{1,9})-\d+(\.[^.]*)?)");
  static const std::regex earlier(  // of earlier versions, which did not name the machine
      R"((?:checkpoint\.nerf|(?:config|transforms|refined_transforms|effects|eval|study|steps)\.json))"
      R"(\.tmp(\d{1,9}))");
  std::smatch match;
  if (std::regex_match(name, match, ours)) return match[1] == HostName() ? match[2].str() : "";
  if (std::regex_match(name, match, earlier)) return match[1];
  return "";
}

}  // namespace

TemporaryFile::TemporaryFile(fs::path final_path)
    : final_path_(std::move(final_path)), path_(NameBeside(final_path_)) {
  std::error_code ignored;
  if (!fs::is_directory(FolderOf(final_path_), ignored)) {
    throw InputError("{}: cannot be written, the folder {} does not exist", final_path_.string(),
                     FolderOf(final_path_).string());
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

void SyncFolderOf(const fs::path& file) {
  const int folder = open(FolderOf(file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  fsync(folder);  // file systems that cannot do it say so; there is nothing to be done about it
  close(folder);
}

void RemoveAbandonedFiles(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string writer = WriterOf(it->path().filename().string());
    std::error_code ignored;
    if (!writer.empty() && it->is_regular_file(ignored) && !IsRunning(writer)) {
      fs::remove(it->path(), ignored);
    }
  }
}

}  // namespace nerf
