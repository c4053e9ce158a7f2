#include "nerf/base/checkpoint_file.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"

namespace nerf {
namespace {

static_assert(std::endian::native == std::endian::little, "files are little-endian");

constexpr char kMetadataKey[] = "__metadata__", kCrcKey[] = "crc32";
constexpr std::size_t kCrcSize = 4;
constexpr std::uint64_t kLargestHeader = 100'000'000;  // bytes, the limit of safetensors

constexpr std::array<std::pair<std::string_view, std::uint64_t>, 5> kSizes = {
    {{"F32", 4}, {"F64", 8}, {"I32", 4}, {"I64", 8}, {"U8", 1}}};

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

// Throws where a header is invalid, for the constructor to catch.
void Require(bool holds) {
  if (!holds) throw std::runtime_error("header");
}

std::uint64_t Count(const nlohmann::json& number) {
  Require(number.is_number_unsigned());
  return number.get<std::uint64_t>();
}

// The bytes of a tensor within the data.
struct ByteRange {
  std::uint64_t begin = 0, end = 0;
};
ByteRange RangeOf(const nlohmann::json& entry) {
  const auto& offsets = entry.at("data_offsets");
  return {Count(offsets.at(0)), Count(offsets.at(1))};
}

// Tensors must neither overlap nor leave gaps, so that the file is as large as its header claims.
void CheckRanges(const nlohmann::json& header, std::uint64_t data_size) {
  std::map<std::uint64_t, std::uint64_t> end_of;
  for (const auto& [name, entry] : header.items()) {
    if (name == kMetadataKey) continue;
    const auto [begin, end] = RangeOf(entry);
    Require(begin <= end && end <= data_size);
    if (begin < end) Require(end_of.emplace(begin, end).second);
  }
  std::uint64_t reached = 0;
  for (const auto& [begin, end] : end_of) {
    Require(begin == reached);
    reached = end;
  }
  Require(reached == data_size);
}

// A tensor as the header describes it.
StoredTensor TensorFrom(const nlohmann::json& entry, std::string_view data) {
  const auto [begin, end] = RangeOf(entry);
  StoredTensor tensor;
  tensor.type = entry.at("dtype");
  const auto known = std::ranges::find(kSizes, tensor.type, &decltype(kSizes)::value_type::first);
  Require(known != kSizes.end());
  std::uint64_t bytes = known->second;
  for (const auto& number : entry.at("shape")) {
    const std::uint64_t size = Count(number);
    // Checked before multiplying, so that no product overflows into one that fits.
    Require(size <= data.size() && (size == 0 || bytes <= data.size() / size));
    bytes *= size;
    tensor.shape.push_back(static_cast<std::int64_t>(size));
  }
  Require(bytes == end - begin);
  tensor.bytes = data.substr(begin, bytes);
  return tensor;
}

[[noreturn]] void RefuseVersion(const std::filesystem::path& path, const std::string& version) {
  throw InputError(
      "{}: is a checkpoint of version {}, this program reads version {}; use the program that "
      "wrote it, or train again",
      path.string(), version, kCheckpointVersion);
}

}  // namespace

void WriteCheckpointFile(const std::filesystem::path& path, const nlohmann::json& meta,
                         const std::map<std::string, StoredTensor>& tensors) {
  nlohmann::ordered_json header;  // the metadata first, as other writers do
  header[kMetadataKey] = {{"format", "nerf-cpu"},
                          {"version", std::to_string(kCheckpointVersion)},
                          {"meta", meta.dump()}};
  std::uint64_t end = 0;
  const auto describe = [&](const std::string& name, const std::string& type,
                            const std::vector<std::int64_t>& shape, std::uint64_t size) {
    header[name] = {{"dtype", type}, {"shape", shape}, {"data_offsets", {end, end + size}}};
    end += size;
  };
  for (const auto& [name, tensor] : tensors) {
    describe(name, tensor.type, tensor.shape, tensor.bytes.size());
  }
  describe(kCrcKey, "U8", {kCrcSize}, kCrcSize);

  std::string text = header.dump();
  text.resize((text.size() + 7) / 8 * 8, ' ');  // tensors are aligned to eight bytes
  std::string bytes;
  bytes.reserve(8 + text.size() + end);
  Append<std::uint64_t>(bytes, text.size());
  bytes += text;
  for (const auto& [name, tensor] : tensors) bytes += tensor.bytes;
  Append(bytes, Crc32(bytes));
  WriteFileAtomically(path, bytes);
}

CheckpointFile::CheckpointFile(const std::filesystem::path& path) : bytes_(ReadWholeFile(path)) {
  const std::string_view all = bytes_;
  if (all.starts_with("NERFCKPT")) RefuseVersion(path, "2 or older");
  const bool whole = all.size() >= 8 + kCrcSize &&
                     ValueAt<std::uint64_t>(all, 0) <= all.size() - 8 - kCrcSize &&
                     ValueAt<std::uint64_t>(all, 0) <= kLargestHeader &&
                     ValueAt<std::uint32_t>(all, all.size() - kCrcSize) ==
                         Crc32(all.substr(0, all.size() - kCrcSize));
  if (!whole) {
    throw InputError(
        "{}: is truncated, damaged, or no checkpoint ({} bytes); train again, or name a run folder",
        path.string(), all.size());
  }
  const std::uint64_t header_size = ValueAt<std::uint64_t>(all, 0);
  const std::string_view data = all.substr(8 + header_size);
  try {
    const auto header = nlohmann::json::parse(all.substr(8, header_size));
    const nlohmann::json& metadata = header.at(kMetadataKey);
    const std::string version = metadata.at("version");
    if (version != std::to_string(kCheckpointVersion)) RefuseVersion(path, version);
    CheckRanges(header, data.size());
    meta_ = nlohmann::json::parse(metadata.at("meta").get<std::string>());
    for (const auto& [name, entry] : header.items()) {
      if (name == kMetadataKey || name == kCrcKey) continue;
      tensors_[name] = TensorFrom(entry, data);
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception&) {
    // The checksum is correct, so the file was written like this, but not by this program.
    throw InputError("{}: has an invalid header; use the program that wrote it, or train again",
                     path.string());
  }
}

}  // namespace nerf
