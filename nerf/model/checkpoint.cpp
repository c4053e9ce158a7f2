#include "nerf/model/checkpoint.h"

#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include "nerf/base/input_error.h"

namespace nerf {
namespace {

constexpr std::array<std::pair<const char*, torch::Dtype>, 5> kTypes = {{{"F32", torch::kFloat},
                                                                         {"F64", torch::kDouble},
                                                                         {"I32", torch::kInt},
                                                                         {"I64", torch::kLong},
                                                                         {"U8", torch::kByte}}};

const char* TypeName(torch::Dtype dtype) {
  for (const auto& [name, type] : kTypes) {
    if (type == dtype) return name;
  }
  TORCH_CHECK(false, "WriteCheckpoint: unsupported tensor type ", dtype);
}

torch::Dtype TypeOf(const std::string& name) {
  for (const auto& [known, type] : kTypes) {
    if (known == name) return type;
  }
  TORCH_CHECK(false, "ReadCheckpoint: unknown type ", name);
}

}  // namespace

void WriteCheckpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  std::vector<torch::Tensor> plain;  // owns the data of `stored`
  std::map<std::string, StoredTensor> stored;
  for (const auto& [name, tensor] : checkpoint.tensors) {
    const torch::Tensor& kept = plain.emplace_back(tensor.detach().contiguous());
    stored[name] = {TypeName(kept.scalar_type()),
                    kept.sizes().vec(),
                    {static_cast<const char*>(kept.data_ptr()), kept.nbytes()}};
  }
  WriteCheckpointFile(path, checkpoint.meta, stored);
}

Checkpoint ReadCheckpoint(const std::filesystem::path& path) {
  const CheckpointFile file(path);
  Checkpoint checkpoint;
  checkpoint.meta = file.Meta();
  for (const auto& [name, stored] : file.Tensors()) {
    torch::Tensor tensor = torch::empty(stored.shape, TypeOf(stored.type));
    if (!stored.bytes.empty()) {
      std::memcpy(tensor.data_ptr(), stored.bytes.data(), stored.bytes.size());
    }
    checkpoint.tensors[name] = tensor;
  }
  return checkpoint;
}

void CopyTensor(const std::map<std::string, torch::Tensor>& tensors, const std::string& name,
                torch::Tensor to) {
  const auto found = tensors.find(name);
  if (found == tensors.end() || found->second.sizes() != to.sizes() ||
      found->second.scalar_type() != to.scalar_type()) {
    throw InputError(
        "checkpoint: tensor {} is missing or has another shape; the checkpoint was made with "
        "another configuration",
        name);
  }
  const torch::NoGradGuard no_grad;
  to.copy_(found->second);
}

}  // namespace nerf
