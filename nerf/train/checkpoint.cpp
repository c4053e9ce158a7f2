#include "nerf/train/checkpoint.h"

#include <zlib.h>

#include <array>
#include <bit>
#include <cstring>
#include <string_view>
#include <utility>

#include "sfm/atomic_file.h"
#include "sfm/input_error.h"

namespace nerf {
namespace {

static_assert(std::endian::native == std::endian::little, "files are little endian");

using json = nlohmann::ordered_json;

constexpr char kMetadataKey[] = "__metadata__", kCrcKey[] = "crc32";
constexpr std::size_t kCrcSize = 4;

constexpr std::array<std::pair<const char*, torch::Dtype>, 5> kTypes = {{{"F32", torch::kFloat},
                                                                         {"F64", torch::kDouble},
                                                                         {"I32", torch::kInt},
                                                                         {"I64", torch::kLong},
                                                                         {"U8", torch::kByte}}};

const char* TypeName(torch::Dtype dtype) {
  for (const auto& [name, type] : kTypes) {
    if (type == dtype) return name;
  }
  TORCH_CHECK(false, "WriteCheckpoint: tensors of type ", dtype, " have no place in it");
}

std::uint32_t Crc32(std::string_view bytes) {
  const uLong crc = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  return static_cast<std::uint32_t>(crc);
}

template <class T>
void Append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
T ValueAt(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// A tensor as the header describes it. Throws json::exception, or std::runtime_error where shape,
// type and place do not fit each other or the data.
torch::Tensor TensorFrom(const json& entry, std::string_view data) {
  const auto& offsets = entry.at("data_offsets");
  const std::uint64_t begin = offsets.at(0), end = offsets.at(1);
  if (begin > end || end > data.size()) throw std::runtime_error("data_offsets");
  const std::string type = entry.at("dtype");
  for (const auto& [name, dtype] : kTypes) {
    if (type != name) continue;
    std::vector<std::int64_t> shape;
    std::uint64_t bytes = torch::elementSize(dtype);
    for (const std::uint64_t size : entry.at("shape")) {
      shape.push_back(static_cast<std::int64_t>(size));
      // No product that is larger than the file can wrap around into one that fits.
      if (size > data.size()) throw std::runtime_error("shape");
      bytes *= size;
      if (bytes > data.size()) throw std::runtime_error("shape");
    }
    if (bytes != end - begin) throw std::runtime_error("shape");
    torch::Tensor tensor = torch::empty(shape, dtype);
    std::memcpy(tensor.data_ptr(), data.data() + begin, bytes);
    return tensor;
  }
  throw std::runtime_error("dtype");
}

[[noreturn]] void RefuseVersion(const std::filesystem::path& path, const std::string& version) {
  throw sfm::InputError(
      "{}: is a checkpoint of version {}, this program reads version {}; use the program that "
      "wrote it, or train again",
      path.string(), version, kCheckpointVersion);
}

}  // namespace

void WriteCheckpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  json header;
  header[kMetadataKey] = {{"format", "nerf-cpu"},
                          {"version", std::to_string(kCheckpointVersion)},
                          {"meta", checkpoint.meta.dump()}};
  std::uint64_t end = 0;
  const auto describe = [&](const std::string& name, const char* type, at::IntArrayRef shape,
                            std::uint64_t size) {
    header[name] = {{"dtype", type}, {"shape", shape.vec()}, {"data_offsets", {end, end + size}}};
    end += size;
  };
  for (const auto& [name, tensor] : checkpoint.tensors) {
    describe(name, TypeName(tensor.scalar_type()), tensor.sizes(), tensor.nbytes());
  }
  describe(kCrcKey, "U8", {kCrcSize}, kCrcSize);

  std::string text = header.dump();
  text.resize((text.size() + 7) / 8 * 8, ' ');  // tensors begin at a multiple of eight bytes
  std::string bytes;
  bytes.reserve(8 + text.size() + end);
  Append<std::uint64_t>(bytes, text.size());
  bytes += text;
  for (const auto& [name, tensor] : checkpoint.tensors) {
    const torch::Tensor plain = tensor.detach().contiguous();
    bytes.append(static_cast<const char*>(plain.data_ptr()), plain.nbytes());
  }
  Append(bytes, Crc32(bytes));
  sfm::WriteFileAtomically(path, bytes);
}

Checkpoint ReadCheckpoint(const std::filesystem::path& path) {
  const std::string bytes = sfm::ReadWholeFile(path);
  const std::string_view all = bytes;
  if (all.starts_with("NERFCKPT")) RefuseVersion(path, "2 or older");
  const bool whole = all.size() >= 8 + kCrcSize &&
                     ValueAt<std::uint64_t>(all, 0) <= all.size() - 8 - kCrcSize &&
                     ValueAt<std::uint32_t>(all, all.size() - kCrcSize) ==
                         Crc32(all.substr(0, all.size() - kCrcSize));
  if (!whole) {
    throw sfm::InputError(
        "{}: is cut short, damaged, or no checkpoint ({} bytes); train again, or name a run folder",
        path.string(), all.size());
  }
  const std::uint64_t header_size = ValueAt<std::uint64_t>(all, 0);
  const std::string_view data = all.substr(8 + header_size);
  try {
    const json header = json::parse(all.substr(8, header_size));
    const json& metadata = header.at(kMetadataKey);
    const std::string version = metadata.at("version");
    if (version != std::to_string(kCheckpointVersion)) RefuseVersion(path, version);
    Checkpoint checkpoint;
    checkpoint.meta = nlohmann::json::parse(metadata.at("meta").get<std::string>());
    for (const auto& [name, entry] : header.items()) {
      if (name == kMetadataKey || name == kCrcKey) continue;
      checkpoint.tensors[name] = TensorFrom(entry, data);
    }
    return checkpoint;
  } catch (const sfm::InputError&) {
    throw;
  } catch (const std::exception&) {
    // The sum was right, so somebody meant it so, but not a version of this program.
    throw sfm::InputError("{}: cannot be understood; use the program that wrote it, or train again",
                          path.string());
  }
}

void CopyTensor(const std::map<std::string, torch::Tensor>& tensors, const std::string& name,
                torch::Tensor to) {
  const auto found = tensors.find(name);
  if (found == tensors.end() || found->second.sizes() != to.sizes() ||
      found->second.scalar_type() != to.scalar_type()) {
    throw sfm::InputError(
        "checkpoint: tensor {} is missing or of another shape; it was made with another "
        "configuration",
        name);
  }
  const torch::NoGradGuard no_grad;
  to.copy_(found->second);
}

}  // namespace nerf
