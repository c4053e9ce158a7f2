#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "nerf/base/checkpoint_file.h"
#include "nerf/field/libtorch.h"

namespace nerf {

// Everything a run needs to go on, or to render: numbers and texts in `meta`, tensors by name.
struct Checkpoint {
  nlohmann::json meta;
  std::map<std::string, torch::Tensor> tensors;  // float, double, int32, int64 or uint8
};

// Written atomically: after a kill or on a full disk the file that stood there before still stands.
// Throws InputError naming the file and the reason.
void WriteCheckpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

// Throws InputError naming the file when it is missing, cut short, damaged, or of another
// version.
Checkpoint ReadCheckpoint(const std::filesystem::path& path);

// Copies tensors[name] into `to`. Throws InputError when it is missing or of another shape or
// type: the checkpoint was made with another configuration.
void CopyTensor(const std::map<std::string, torch::Tensor>& tensors, const std::string& name,
                torch::Tensor to);

}  // namespace nerf
