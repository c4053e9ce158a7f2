#include "nerf/train/checkpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "sfm/atomic_file.h"
#include "sfm/input_error.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

class CheckpointFile : public testing::Test {
 protected:
  CheckpointFile() {
    checkpoint_.meta["step"] = 42;
    checkpoint_.tensors["field.a.weight"] = torch::arange(12, torch::kFloat).view({3, 4});
    checkpoint_.tensors["count"] = torch::tensor(7, torch::kLong);
    WriteCheckpoint(path_, checkpoint_);
  }

  std::string ErrorOnRead() {
    try {
      ReadCheckpoint(path_);
    } catch (const sfm::InputError& error) {
      return error.what();
    }
    return "no error";
  }

  test::ScratchFolder folder_;
  std::filesystem::path path_ = folder_.path() / "checkpoint.nerf";
  Checkpoint checkpoint_;
};

TEST_F(CheckpointFile, ComesBack) {
  const Checkpoint read = ReadCheckpoint(path_);
  EXPECT_EQ(read.meta.at("step"), 42);
  EXPECT_TRUE(
      torch::equal(read.tensors.at("field.a.weight"), checkpoint_.tensors["field.a.weight"]));
  EXPECT_EQ(read.tensors.at("count").item<int>(), 7);
}

TEST_F(CheckpointFile, CutShortAnywhereIsRefused) {
  const std::string whole = sfm::ReadWholeFile(path_);
  for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 97) {
    std::ofstream(path_, std::ios::binary) << whole.substr(0, size);
    EXPECT_THAT(ErrorOnRead(), testing::HasSubstr("checkpoint.nerf")) << size;
  }
}

TEST_F(CheckpointFile, AFlippedBitIsFound) {
  const std::string whole = sfm::ReadWholeFile(path_);
  for (std::size_t at = 24; at < whole.size(); at += 1 + whole.size() / 53) {
    std::string damaged = whole;
    damaged[at] ^= 0x10;
    std::ofstream(path_, std::ios::binary) << damaged;
    EXPECT_THAT(ErrorOnRead(), testing::HasSubstr("damaged")) << at;
  }
}

TEST_F(CheckpointFile, AnotherVersionIsNamed) {
  std::string bytes = sfm::ReadWholeFile(path_);
  bytes[8] = 9;
  std::ofstream(path_, std::ios::binary) << bytes;
  EXPECT_THAT(ErrorOnRead(), testing::HasSubstr("version 9"));
}

TEST_F(CheckpointFile, ATensorOfAnotherShapeIsNamed) {
  const torch::Tensor to = torch::zeros({4, 3});
  EXPECT_THROW(CopyTensor(checkpoint_.tensors, "field.a.weight", to), sfm::InputError);
  EXPECT_THROW(CopyTensor(checkpoint_.tensors, "no such", to), sfm::InputError);
}

}  // namespace
}  // namespace nerf
