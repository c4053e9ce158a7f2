#pragma once

#include <torch/torch.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace nerf {

// Everything a run needs to go on, or to render: numbers and texts in `meta`, tensors by name.
struct Checkpoint {
  nlohmann::json meta;
  std::map<std::string, torch::Tensor> tensors;
};

// The file: 8 bytes "NERFCKPT", uint32 version, uint32 CRC-32 of the payload, uint64 size of the
// payload, then the payload, a LibTorch archive (a zip that torch::load reads too). Little endian.
inline constexpr std::uint32_t kCheckpointVersion = 2;

// Written atomically: after a kill or on a full disk the file that stood there before still stands.
// Throws sfm::InputError naming the file and the reason.
void WriteCheckpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

// Throws sfm::InputError naming the file when it is missing, cut short, damaged, or of another
// version.
Checkpoint ReadCheckpoint(const std::filesystem::path& path);

// Copies tensors[name] into `to`. Throws sfm::InputError when it is missing or of another shape or
// type: the checkpoint was made with another configuration.
void CopyTensor(const std::map<std::string, torch::Tensor>& tensors, const std::string& name,
                torch::Tensor to);

}  // namespace nerf
