#include <bit>
#include <cstring>
#include <fstream>
#include <limits>
#include <string_view>
#include <type_traits>

#include "nerf/base/file_bytes.h"
#include "nerf/base/input_error.h"
#include "nerf/scene/camera_intrinsics.h"
#include "nerf/scene/camera_models.h"
#include "sfm/colmap_records.h"

namespace fs = std::filesystem;

namespace nerf::sfm::colmap {
namespace {

static_assert(std::endian::native == std::endian::little, "COLMAP's files are little-endian");

// Smallest possible size of each record, in bytes.
constexpr std::size_t kCameraBytes = 4 + 4 + 8 + 8 + 2 * 8;  // EQUIRECTANGULAR, COLMAP 4.1
constexpr std::size_t kImageBytes = 4 + 7 * 8 + 4 + 1 + 8;
constexpr std::size_t kPoint2dBytes = 3 * 8;
constexpr std::size_t kPointBytes = 8 + 3 * 8 + 3 + 8 + 8;
constexpr std::size_t kTrackElementBytes = 4 + 4;

// Reads values from the bytes of a file; throws at its end.
class ByteReader {
 public:
  explicit ByteReader(const fs::path& file) : file_(file), bytes_(ReadFileBytes(file)) {}

  template <class T>
  T Read() {
    static_assert(std::is_arithmetic_v<T>);
    if (Left() < sizeof(T)) ThrowTruncated();
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }

  Eigen::Vector2d ReadVector2() {
    const double x = Read<double>();
    return {x, Read<double>()};
  }

  Eigen::Vector3d ReadVector3() {
    const Eigen::Vector2d xy = ReadVector2();
    return {xy.x(), xy.y(), Read<double>()};
  }

  // Reads a number of records that follow.
  std::size_t ReadCount(std::size_t smallest_record) {
    const auto count = Read<std::uint64_t>();
    if (count > Left() / smallest_record) ThrowTruncated();
    return static_cast<std::size_t>(count);
  }

  std::string ReadName() {
    const std::size_t end = bytes_.find('\0', at_);
    if (end == std::string::npos) ThrowTruncated();
    std::string name = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return name;
  }

  void Skip(std::size_t bytes) {
    if (Left() < bytes) ThrowTruncated();
    at_ += bytes;
  }

  void ExpectEnd() const {
    if (Left() == 0) return;
    throw InputError("{}: {} bytes follow the last record; the file is damaged, export it again",
                     file_.string(), Left());
  }

 private:
  std::size_t Left() const { return bytes_.size() - at_; }

  [[noreturn]] void ThrowTruncated() const {
    throw InputError("{}: truncated or damaged at byte {} of {}; copy or export it again",
                     file_.string(), at_, bytes_.size());
  }

  fs::path file_;
  std::string bytes_;
  std::size_t at_ = 0;
};

}  // namespace

CameraMap ReadCamerasBinary(const fs::path& file) {
  ByteReader reader(file);
  CameraMap cameras;
  for (std::size_t left = reader.ReadCount(kCameraBytes); left > 0; --left) {
    const auto id = reader.Read<std::uint32_t>();
    const std::string where = fmt::format("{}: camera {}", file.string(), id);
    const int model_id = reader.Read<std::int32_t>();
    const auto model = CameraModelFromId(model_id);
    if (!model) throw InputError("{}: {}", where, UnsupportedLens(std::to_string(model_id)));
    Camera camera{*model, 0, 0, {}};
    const auto width = reader.Read<std::uint64_t>();
    const auto height = reader.Read<std::uint64_t>();
    if (width > std::numeric_limits<int>::max() || height > std::numeric_limits<int>::max()) {
      throw InputError("{}: impossible image size {}x{}", where, width, height);
    }
    camera.width = static_cast<int>(width);
    camera.height = static_cast<int>(height);
    for (int i = 0; i < CameraModelNumParams(*model); ++i) {
      camera.params.push_back(reader.Read<double>());
    }
    CheckCamera(camera, where);
    if (!cameras.emplace(id, camera).second) throw InputError("{}: listed twice", where);
  }
  reader.ExpectEnd();
  return cameras;
}

std::vector<ImageRecord> ReadImagesBinary(const fs::path& file) {
  ByteReader reader(file);
  std::vector<ImageRecord> images(reader.ReadCount(kImageBytes));
  for (ImageRecord& image : images) {
    image.id = reader.Read<std::uint32_t>();
    const double w = reader.Read<double>();
    // Not inside the comma initializer, which asserts when an exception is thrown inside it.
    const Eigen::Vector3d xyz = reader.ReadVector3();
    image.rotation << w, xyz;
    image.translation = reader.ReadVector3();
    image.camera_id = reader.Read<std::uint32_t>();
    image.name = reader.ReadName();
    image.points2d.resize(reader.ReadCount(kPoint2dBytes));
    for (Eigen::Vector2d& pixel : image.points2d) {
      pixel = reader.ReadVector2();
      reader.Skip(sizeof(std::uint64_t));  // the id of the point, which points3D has too
    }
  }
  reader.ExpectEnd();
  return images;
}

std::vector<PointRecord> ReadPointsBinary(const fs::path& file) {
  ByteReader reader(file);
  std::vector<PointRecord> points(reader.ReadCount(kPointBytes));
  for (PointRecord& point : points) {
    point.id = reader.Read<std::uint64_t>();
    point.x_in_world = reader.ReadVector3();
    for (std::uint8_t& channel : point.rgb) channel = reader.Read<std::uint8_t>();
    point.reprojection_error = reader.Read<double>();
    point.track.resize(reader.ReadCount(kTrackElementBytes));
    for (auto& [image_id, point2d] : point.track) {
      image_id = reader.Read<std::uint32_t>();
      point2d = reader.Read<std::uint32_t>();
    }
  }
  reader.ExpectEnd();
  return points;
}

int CountImagesBinary(const fs::path& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  std::uint64_t count = 0;
  stream.read(reinterpret_cast<char*>(&count), sizeof(count));
  if (error || !stream || count > (size - sizeof(count)) / kImageBytes ||
      count > std::numeric_limits<int>::max()) {
    throw InputError("{}: truncated or damaged; copy or export it again", file.string());
  }
  return static_cast<int>(count);
}

}  // namespace nerf::sfm::colmap
