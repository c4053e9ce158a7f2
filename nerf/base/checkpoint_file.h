#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace nerf {

// A checkpoint's file is of the safetensors format, which Python's safetensors reads too: uint64
// size of the header, the header as JSON, then the tensors, little endian. Its metadata hold the
// format's version and the run's own; the last tensor, "crc32", is the CRC-32 of all bytes before
// it. A LibTorch archive would do as well, but its pickles may hold programs: a run from a stranger
// is only data. Source: huggingface/safetensors, README "Format".
inline constexpr int kCheckpointVersion = 3;

struct StoredTensor {
  std::string type;                 // "F32", "F64", "I32", "I64" or "U8"
  std::vector<std::int64_t> shape;  // whose product is the number of values in `bytes`
  std::string_view bytes;
};

// Written atomically: after a kill or on a full disk the file that stood there before still stands.
// Throws InputError naming the file and the reason.
void WriteCheckpointFile(const std::filesystem::path& path, const nlohmann::json& meta,
                         const std::map<std::string, StoredTensor>& tensors);

// The file in memory, with every claim of its header checked. Needs no LibTorch, so that it can be
// fuzzed without.
class CheckpointFile {
 public:
  // Throws InputError naming the file when it is missing, cut short, damaged, or of another
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
