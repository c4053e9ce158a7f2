#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "nerf/base/checkpoint_file.h"
#include "nerf/field/libtorch.h"

namespace nerf {

// All data needed to resume a run or to render it.
struct Checkpoint {
  nlohmann::json meta;
  std::map<std::string, torch::Tensor> tensors;  // float, double, int32, int64 or uint8
};

// Writes atomically: if the process is killed or the disk is full, a previous file stays intact.
// Throws InputError naming the file and the reason.
void WriteCheckpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

// Throws InputError naming the file if it is missing, truncated, damaged, or of another version.
Checkpoint ReadCheckpoint(const std::filesystem::path& path);

// Copies tensors[name] into `to`. Throws InputError if it is missing or has another shape or type,
// as in a checkpoint of another configuration.
void CopyTensor(const std::map<std::string, torch::Tensor>& tensors, const std::string& name,
                torch::Tensor to);

}  // namespace nerf
