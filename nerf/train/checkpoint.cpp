#include "nerf/train/checkpoint.h"

#include <zlib.h>

#include <cstring>
#include <sstream>

#include "sfm/atomic_file.h"
#include "sfm/input_error.h"

namespace nerf {
namespace {

struct Header {
  char magic[8] = {'N', 'E', 'R', 'F', 'C', 'K', 'P', 'T'};
  std::uint32_t version = kCheckpointVersion;
  std::uint32_t crc = 0;
  std::uint64_t size = 0;
};
static_assert(sizeof(Header) == 24);

constexpr char kMetaKey[] = "meta";
constexpr char kTensorPrefix[] = "tensor.";

std::uint32_t Crc32(std::string_view bytes) {
  uLong crc = crc32_z(0, nullptr, 0);
  crc = crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  return static_cast<std::uint32_t>(crc);
}

// Archive keys must not hold dots, which separate sub-modules.
std::string KeyOf(const std::string& name) {
  std::string key = kTensorPrefix + name;
  for (char& c : key) {
    if (c == '.') c = '/';
  }
  return key;
}

}  // namespace

void WriteCheckpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  torch::serialize::OutputArchive archive;
  nlohmann::json meta = checkpoint.meta;
  meta["tensors"] = nlohmann::json::array();
  for (const auto& [name, tensor] : checkpoint.tensors) {
    archive.write(KeyOf(name), tensor.detach(), /*is_buffer=*/true);
    meta["tensors"].push_back(name);
  }
  archive.write(kMetaKey, c10::IValue(meta.dump()));
  std::ostringstream stream;
  archive.save_to(stream);
  const std::string payload = std::move(stream).str();

  Header header;
  header.crc = Crc32(payload);
  header.size = payload.size();
  std::string bytes(sizeof(Header) + payload.size(), '\0');
  std::memcpy(bytes.data(), &header, sizeof(Header));
  std::memcpy(bytes.data() + sizeof(Header), payload.data(), payload.size());
  sfm::WriteFileAtomically(path, bytes);
}

Checkpoint ReadCheckpoint(const std::filesystem::path& path) {
  std::string bytes = sfm::ReadWholeFile(path);
  Header header;
  const Header expected;
  if (bytes.size() < sizeof(Header) || std::memcmp(bytes.data(), expected.magic, 8) != 0) {
    throw sfm::InputError(
        "{}: is not a checkpoint of this program; train again, or name a run folder",
        path.string());
  }
  std::memcpy(&header, bytes.data(), sizeof(Header));
  if (header.version != kCheckpointVersion) {
    throw sfm::InputError(
        "{}: is a checkpoint of version {}, this program reads version {}; use the program that "
        "wrote it, or train again",
        path.string(), header.version, kCheckpointVersion);
  }
  bytes.erase(0, sizeof(Header));
  if (bytes.size() != header.size || Crc32(bytes) != header.crc) {
    throw sfm::InputError(
        "{}: is cut short or damaged ({} of {} bytes); train again from the start", path.string(),
        bytes.size(), header.size);
  }
  try {
    std::istringstream stream(std::move(bytes));
    torch::serialize::InputArchive archive;
    archive.load_from(stream);
    Checkpoint checkpoint;
    c10::IValue meta;
    archive.read(kMetaKey, meta);
    checkpoint.meta = nlohmann::json::parse(meta.toStringRef());
    for (const std::string name : checkpoint.meta.at("tensors")) {
      archive.read(KeyOf(name), checkpoint.tensors[name], /*is_buffer=*/true);
    }
    return checkpoint;
  } catch (const std::exception&) {
    // The sum was right, so this program wrote it, but not this version of it or of LibTorch.
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
