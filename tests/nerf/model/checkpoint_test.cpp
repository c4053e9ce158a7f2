#include "nerf/model/checkpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <fstream>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
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
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  // Writes the bytes with a valid checksum at the end.
  void WriteWithValidChecksum(std::string bytes) {
    const auto crc = static_cast<std::uint32_t>(
        crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size() - 4));
    std::memcpy(bytes.data() + bytes.size() - 4, &crc, 4);
    std::ofstream(path_, std::ios::binary) << bytes;
  }

  test::ScratchFolder folder_;
  std::filesystem::path path_ = folder_.path() / "checkpoint.nerf";
  Checkpoint checkpoint_;
};

TEST_F(CheckpointFile, RestoresWhatWasWritten) {
  const Checkpoint read = ReadCheckpoint(path_);
  EXPECT_EQ(read.meta.at("step"), 42);
  EXPECT_TRUE(
      torch::equal(read.tensors.at("field.a.weight"), checkpoint_.tensors["field.a.weight"]));
  EXPECT_EQ(read.tensors.at("count").item<int>(), 7);
}

TEST_F(CheckpointFile, TruncatedAnywhereIsRejected) {
  const std::string whole = ReadWholeFile(path_);
  for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 97) {
    std::ofstream(path_, std::ios::binary) << whole.substr(0, size);
    EXPECT_THAT(ErrorOnRead(), testing::HasSubstr("checkpoint.nerf")) << size;
  }
}

TEST_F(CheckpointFile, AFlippedBitIsFound) {
  const std::string whole = ReadWholeFile(path_);
  for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 53) {
    std::string damaged = whole;
    damaged[at] ^= 0x10;
    std::ofstream(path_, std::ios::binary) << damaged;
    EXPECT_THAT(ErrorOnRead(), testing::HasSubstr("damaged")) << at;
  }
}

TEST_F(CheckpointFile, AnotherVersionIsNamed) {
  std::string bytes = ReadWholeFile(path_);
  bytes.replace(bytes.find("\"version\":\"3\""), 13, "\"version\":\"9\"");
  WriteWithValidChecksum(bytes);
  EXPECT_THAT(ErrorOnRead(), testing::HasSubstr("version 9"));
  std::ofstream(path_, std::ios::binary) << "NERFCKPT and what followed it";
  EXPECT_THAT(ErrorOnRead(), testing::HasSubstr("version 2"));
}

// The same checks as in Python's safetensors: shapes match their bytes, offsets are inside the
// data.
TEST_F(CheckpointFile, AHeaderThatDoesNotMatchItsDataIsRejected) {
  const std::string whole = ReadWholeFile(path_);
  const std::string data = whole.substr(whole.size() - 60);  // 8 + 48 + 4 bytes
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"[3,4]", "[4,4]"},
                                 {"[3,4]", "[3,9]"},
                                 {"\"F32\"", "\"F64\""},
                                 {"\"F32\"", "\"F99\""},
                                 {"[8,56]", "[9,56]"},
                                 {"[8,56]", "[8,99]"},
                                 {"[8,56]", "[56,8]"},
                                 {"[0,8]", "[8,16]"},
                                 {"[0,8]", "[0,9]"},
                                 {"[0,8]", "[-1,8]"},
                                 {"[0,8]", "[0,1e300]"},
                                 {"\"meta\"", "\"mata\""}}) {
    std::uint64_t size = 0;
    std::memcpy(&size, whole.data(), sizeof size);
    std::string header = whole.substr(8, size);
    const std::size_t at = header.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    header.replace(at, from.size(), to);
    size = header.size();
    std::string changed(reinterpret_cast<const char*>(&size), sizeof size);
    changed += header + data;
    WriteWithValidChecksum(changed);
    EXPECT_THAT(ErrorOnRead(), testing::HasSubstr("invalid header")) << from << " " << to;
  }
}

TEST_F(CheckpointFile, TensorsKeepTypeShapeAndBits) {
  Checkpoint odd;
  odd.tensors["empty"] = torch::empty({0, 3});
  odd.tensors["scalar"] = torch::tensor(0.1, torch::kDouble);
  odd.tensors["strided"] = torch::arange(6, torch::kInt).view({2, 3}).t();
  odd.tensors["nan"] = torch::full({2}, NAN);
  WriteCheckpoint(path_, odd);
  const Checkpoint read = ReadCheckpoint(path_);
  ASSERT_EQ(read.tensors.size(), 4u);
  EXPECT_EQ(read.tensors.at("empty").sizes(), at::IntArrayRef({0, 3}));
  EXPECT_EQ(read.tensors.at("scalar").item<double>(), 0.1);
  EXPECT_TRUE(torch::equal(read.tensors.at("strided"), odd.tensors["strided"]));
  EXPECT_TRUE(torch::isnan(read.tensors.at("nan")).all().item<bool>());
}

TEST_F(CheckpointFile, ATensorOfAnotherShapeIsNamed) {
  const torch::Tensor to = torch::zeros({4, 3});
  EXPECT_THROW(CopyTensor(checkpoint_.tensors, "field.a.weight", to), InputError);
  EXPECT_THROW(CopyTensor(checkpoint_.tensors, "no such", to), InputError);
}

}  // namespace
}  // namespace nerf
