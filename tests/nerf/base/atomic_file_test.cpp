#include "nerf/base/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "nerf/base/input_error.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public testing::Test {
 protected:
  AtomicFile() : folder_(fs::temp_directory_path() / ("atomic_file_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~AtomicFile() override { fs::remove_all(folder_); }

  std::size_t FilesInFolder() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  fs::path folder_;
};

TEST_F(AtomicFile, WritesAndReadsBack) {
  WriteFileAtomically(folder_ / "a", std::string("one\0two", 7));
  EXPECT_EQ(ReadWholeFile(folder_ / "a"), std::string("one\0two", 7));
  EXPECT_EQ(FilesInFolder(), 1u);
}

// A file size limit stands in for a full disk: write() fails half-way in the same manner.
TEST_F(AtomicFile, AFullDiskLeavesTheOldFileAndNothingElse) {
  WriteFileAtomically(folder_ / "a", "the last good one");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small = {4096, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(WriteFileAtomically(folder_ / "a", std::string(1 << 20, 'x')), InputError);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(ReadWholeFile(folder_ / "a"), "the last good one");
  EXPECT_EQ(FilesInFolder(), 1u);
}

TEST_F(AtomicFile, AMissingFolderIsNamed) {
  try {
    WriteFileAtomically(folder_ / "no" / "such", "x");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no/such"), std::string::npos);
  }
}

TEST_F(AtomicFile, AnOutputFolderThatIsAFileIsRefused) {
  WriteFileAtomically(folder_ / "a", "x");
  EXPECT_THROW(MakeOutputFolder(folder_ / "a" / "b"), InputError);
  EXPECT_NO_THROW(MakeOutputFolder(folder_ / "b" / "c"));
}

TEST_F(AtomicFile, AMissingFileIsNamed) {
  EXPECT_THROW(ReadWholeFile(folder_ / "none"), InputError);
}

}  // namespace
}  // namespace nerf
