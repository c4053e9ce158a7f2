#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include "nerf/base/file_bytes.h"
#include "nerf/base/input_error.h"
#include "nerf/scene/camera_intrinsics.h"
#include "nerf/scene/camera_models.h"
#include "sfm/colmap_records.h"

namespace fs = std::filesystem;

namespace nerf::sfm::colmap {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::string_view Trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

// The words of one line, and its location for messages.
class Line {
 public:
  Line(const fs::path& file, int number, std::string_view text)
      : file_(&file), number_(number), rest_(Trimmed(text)) {}

  bool IsEmpty() const { return rest_.empty(); }
  bool IsCommentOrEmpty() const { return rest_.empty() || rest_.front() == '#'; }
  std::string Where() const { return fmt::format("{}:{}", file_->string(), number_); }

  std::string_view Word() {
    if (rest_.empty()) throw InputError("{}: the line is truncated", Where());
    const auto end = std::min(rest_.find_first_of(kBlanks), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_ = Trimmed(rest_.substr(end));
    return word;
  }

  template <class T>
  T Number() {
    const std::string_view word = Word();
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
      throw InputError("{}: '{}' is not a number that fits here", Where(), word);
    }
    return value;
  }

  Eigen::Vector3d Vector3() {
    const double x = Number<double>();
    const double y = Number<double>();
    return {x, y, Number<double>()};
  }

  // The rest of the line: image names may contain blanks.
  std::string Rest() {
    if (rest_.empty()) throw InputError("{}: the line is truncated", Where());
    return std::string(std::exchange(rest_, {}));
  }

 private:
  const fs::path* file_;
  int number_;
  std::string_view rest_;
};

class LineReader {
 public:
  explicit LineReader(const fs::path& file) : file_(file), text_(ReadFileBytes(file)) {}

  std::optional<Line> Next() {
    if (at_ >= text_.size()) return std::nullopt;
    const auto end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view line = std::string_view(text_).substr(at_, end - at_);
    at_ = end + 1;
    return Line(file_, ++number_, line);
  }

  std::optional<Line> NextRecord() {
    auto line = Next();
    while (line && line->IsCommentOrEmpty()) line = Next();
    return line;
  }

 private:
  const fs::path& file_;
  std::string text_;
  std::size_t at_ = 0;
  int number_ = 0;
};

}  // namespace

CameraMap ReadCamerasText(const fs::path& file) {
  LineReader lines(file);
  CameraMap cameras;
  while (auto line = lines.NextRecord()) {
    const auto id = line->Number<std::uint32_t>();
    const std::string where = fmt::format("{}: camera {}", line->Where(), id);
    const std::string_view name = line->Word();
    const auto model = CameraModelFromName(name);
    if (!model) throw InputError("{}: {}", where, UnsupportedLens(name));
    Camera camera{*model, 0, 0, {}};
    camera.width = line->Number<int>();
    camera.height = line->Number<int>();
    while (!line->IsEmpty()) camera.params.push_back(line->Number<double>());
    CheckCamera(camera, where);
    if (!cameras.emplace(id, camera).second) throw InputError("{}: listed twice", where);
  }
  return cameras;
}

// An image has two lines. Where the second is left out, the next image is in its place.
void RequirePoints(Line line, const std::string& image) {
  constexpr int kWordsOfAnImage = 10;
  int words = 0;
  bool numbers = true;
  const std::string where = line.Where();
  for (; !line.IsEmpty(); ++words) {
    const std::string_view word = line.Word();
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    numbers = numbers && error == std::errc() && end == word.data() + word.size();
  }
  if (words < kWordsOfAnImage || numbers) return;
  throw InputError(
      "{}: another image, where the second line of image '{}' should be: its points X Y "
      "POINT3D_ID, "
      "or an empty line",
      where, image);
}

std::vector<ImageRecord> ReadImagesText(const fs::path& file) {
  LineReader lines(file);
  std::vector<ImageRecord> images;
  while (auto line = lines.NextRecord()) {
    ImageRecord& image = images.emplace_back();
    image.id = line->Number<std::uint32_t>();
    const double w = line->Number<double>();
    // Not inside the comma initializer, which asserts when an exception is thrown inside it.
    const Eigen::Vector3d xyz = line->Vector3();
    image.rotation << w, xyz;
    image.translation = line->Vector3();
    image.camera_id = line->Number<std::uint32_t>();
    image.name = line->Rest();
    // The second line of an image is empty where it has no points.
    auto points = lines.Next();
    if (points) RequirePoints(*points, image.name);
    while (points && !points->IsEmpty()) {
      const double x = points->Number<double>();
      image.points2d.emplace_back(x, points->Number<double>());
      points->Word();  // the id of the point, which points3D has too
    }
  }
  return images;
}

std::vector<PointRecord> ReadPointsText(const fs::path& file) {
  LineReader lines(file);
  std::vector<PointRecord> points;
  while (auto line = lines.NextRecord()) {
    PointRecord& point = points.emplace_back();
    point.id = line->Number<std::uint64_t>();
    point.x_in_world = line->Vector3();
    for (std::uint8_t& channel : point.rgb) channel = line->Number<std::uint8_t>();
    point.reprojection_error = line->Number<double>();
    while (!line->IsEmpty()) {
      const auto image_id = line->Number<std::uint32_t>();
      point.track.emplace_back(image_id, line->Number<std::uint32_t>());
    }
  }
  return points;
}

int CountImagesText(const fs::path& file) {
  LineReader lines(file);
  int count = 0;
  for (; lines.NextRecord(); ++count) lines.Next();
  return count;
}

}  // namespace nerf::sfm::colmap
