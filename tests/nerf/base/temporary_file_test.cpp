#include "nerf/base/temporary_file.h"

#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <set>
#include <string>

#include "nerf/base/input_error.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

class TemporaryFileTest : public testing::Test {
 protected:
  TemporaryFileTest() { fs::create_directories(folder_); }
  ~TemporaryFileTest() override { fs::remove_all(folder_); }
  fs::path folder_ = fs::temp_directory_path() / ("nerf_temporary_" + std::to_string(::getpid()));
};

TEST_F(TemporaryFileTest, IsRemovedUnlessItIsKept) {
  {
    const TemporaryFile file(folder_ / "a.b.png");
    EXPECT_EQ(file.path().extension(), ".png");
    EXPECT_EQ(file.path().parent_path(), folder_);
    std::ofstream(file.path()) << "half";
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(TemporaryFileTest, ReplacesTheOldFileWhenKept) {
  std::ofstream(folder_ / "a.txt") << "old";
  {
    TemporaryFile file(folder_ / "a.txt");
    std::ofstream(file.path()) << "new";
    file.Keep();
  }
  std::string text;
  std::ifstream(folder_ / "a.txt") >> text;
  EXPECT_EQ(text, "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(TemporaryFileTest, TwoWritersOfOneFileDoNotInterfere) {
  EXPECT_NE(TemporaryFile(folder_ / "a").path(), TemporaryFile(folder_ / "a").path());
}

TEST_F(TemporaryFileTest, RefusesAMissingFolder) {
  EXPECT_THROW(TemporaryFile(folder_ / "none" / "a.txt"), InputError);
}

TEST_F(TemporaryFileTest, ThrowsWhereThereIsNothingToKeep) {
  TemporaryFile file(folder_ / "a.txt");
  EXPECT_THROW(file.Keep(), InputError);
}

TEST_F(TemporaryFileTest, OfAKilledWriterIsRemovedByTheNextRun) {
  const pid_t writer = fork();
  if (writer == 0) {
    for (const char* name : {"checkpoint.nerf", "picture.png"}) {
      auto* const abandoned = new TemporaryFile(folder_ / name);
      std::ofstream(abandoned->path()) << "half";
    }
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(writer, &status, 0), writer);
  std::ofstream(folder_ / fmt::format("checkpoint.nerf.tmp{}", writer)) << "of an earlier version";
  const TemporaryFile ours(folder_ / "ours.txt");
  std::ofstream(ours.path()) << "being written";
  std::ofstream(folder_ / ".other.tmp-anothermachine-1-0.txt") << "being written elsewhere";
  std::ofstream(folder_ / "notes.tmp") << "the user's";
  std::ofstream(folder_ / fmt::format("thesis.tmp{}", writer)) << "the user's";
  RemoveAbandonedFiles(folder_);
  std::set<std::string> left;
  for (const auto& entry : fs::directory_iterator(folder_)) left.insert(entry.path().filename());
  EXPECT_EQ(left, (std::set<std::string>{ours.path().filename(), "notes.tmp",
                                         fmt::format("thesis.tmp{}", writer),
                                         ".other.tmp-anothermachine-1-0.txt"}));
}

}  // namespace
}  // namespace nerf
