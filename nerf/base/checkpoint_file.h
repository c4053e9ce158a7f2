#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace nerf {

// Checkpoints are files of the safetensors format, which Python's safetensors reads too: the uint64
// size of the header, the header as JSON, then the tensors, little-endian. The metadata contain the
// version of the format and those of the run; the last tensor, "crc32", is the CRC-32 of all bytes
// before it. Unlike the pickles of a LibTorch archive, the format cannot contain code, so that a
// checkpoint from a stranger is safe to open. Source: huggingface/safetensors, README "Format".
inline constexpr int kCheckpointVersion = 3;

struct StoredTensor {
  std::string type;                 // "F32", "F64", "I32", "I64" or "U8"
  std::vector<std::int64_t> shape;  // its product is the number of values in `bytes`
  std::string_view bytes;
};

// Writes atomically: an existing file survives a crash and a full disk.
// Throws InputError naming the file and the reason.
void WriteCheckpointFile(const std::filesystem::path& path, const nlohmann::json& meta,
                         const std::map<std::string, StoredTensor>& tensors);

// A checkpoint file in memory, its header validated. Does not use LibTorch, so that it can be
// fuzzed without it.
class CheckpointFile {
 public:
  // Throws InputError naming the file when it is missing, truncated, damaged, or of another
  // version.
  explicit CheckpointFile(const std::filesystem::path& path);
  CheckpointFile(const CheckpointFile&) = delete;  // the tensors point into it
  CheckpointFile& operator=(const CheckpointFile&) = delete;

  const nlohmann::json& Meta() const { return meta_; }
  const std::map<std::string, StoredTensor>& Tensors() const { return tensors_; }

 private:
  std::string bytes_;
  nlohmann::json meta_;
  std::map<std::string, StoredTensor> tensors_;
};

}  // namespace nerf
