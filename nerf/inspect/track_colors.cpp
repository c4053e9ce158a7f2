#include "nerf/inspect/track_colors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/image/image_convert.h"
#include "nerf/image/image_io.h"
#include "nerf/image/mask.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/photograph.h"

namespace nerf {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kReach = 2;            // pixels on each side, over which light is averaged
constexpr float kDarkest = 0.004f;   // linear; below it, a step of 8 bits exceeds a tenth
constexpr float kBrightest = 0.95f;  // linear, of display-referred photographs; above: clipped
constexpr int kFewestNearby = 2;     // photographs that must observe a point which another misses

struct Light {
  Eigen::Vector3f log_light;
  float contrast;
};

// Mean light around a pixel; nullopt near the border and where it is too dark, clipped or
// transparent.
std::optional<Light> LightAt(const Image& linear, bool may_clip, const Vector2d& pixel) {
  const int x = static_cast<int>(std::floor(pixel.x())),
            y = static_cast<int>(std::floor(pixel.y()));
  if (x < kReach || y < kReach || x + kReach >= linear.width || y + kReach >= linear.height) {
    return std::nullopt;
  }
  constexpr float kCount = (2 * kReach + 1) * (2 * kReach + 1);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float log_sum = 0, log_squares = 0;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      const float* const at = linear.At(x + dx, y + dy);
      if (linear.channels == 4 && at[3] < 1) return std::nullopt;
      const Eigen::Map<const Eigen::Vector3f> light(at);
      sum += light;
      const float log_light = std::log(std::max(light.mean(), kDarkest));
      log_sum += log_light;
      log_squares += log_light * log_light;
    }
  }
  const Eigen::Vector3f mean = sum / kCount;
  if (mean.minCoeff() < kDarkest || (may_clip && mean.maxCoeff() > kBrightest)) return std::nullopt;
  const float variance = log_squares / kCount - (log_sum / kCount) * (log_sum / kCount);
  return Light{mean.array().log().matrix(), std::sqrt(std::max(0.0f, variance))};
}

// The parts of a photograph in which sparse points are observed, as a coarse grid.
class ObservedParts {
 public:
  explicit ObservedParts(const Camera& camera) : camera_(camera), known_(kCells * kCells, false) {}
  void Add(const Vector2d& pixel) { known_[CellOf(pixel)] = true; }
  // Whether no point is observed in the cell of a pixel and in those around it.
  bool IsEmptyAround(const Vector2d& pixel) const {
    const int cell = CellOf(pixel), cx = cell % kCells, cy = cell / kCells;
    for (int y = std::max(0, cy - 1); y <= std::min(kCells - 1, cy + 1); ++y) {
      for (int x = std::max(0, cx - 1); x <= std::min(kCells - 1, cx + 1); ++x) {
        if (known_[y * kCells + x]) return false;
      }
    }
    return true;
  }

 private:
  static constexpr int kCells = 32;  // across and down
  int CellOf(const Vector2d& pixel) const {
    const auto of = [](double at, int size) {
      return std::clamp(static_cast<int>(at / size * kCells), 0, kCells - 1);
    };
    return of(pixel.y(), camera_.height) * kCells + of(pixel.x(), camera_.width);
  }
  const Camera& camera_;
  std::vector<bool> known_;
};

Vector3d CentreOf(const PosedImages& posed, int photograph) {
  return posed.images[photograph].world_from_camera.translation();
}

// The pixel of a photograph to which a point projects; nullopt outside the image.
std::optional<Vector2d> ProjectInto(const PosedImages& posed, int photograph, const Vector3d& x) {
  const PosedImage& image = posed.images[photograph];
  const Camera& camera = posed.cameras[image.camera];
  const auto pixel = PixelFromPoint(camera, image.world_from_camera.inverse() * x);
  const bool inside = pixel && pixel->x() >= 0 && pixel->y() >= 0 && pixel->x() < camera.width &&
                      pixel->y() < camera.height;
  return inside ? pixel : std::nullopt;
}

bool IsObservedBy(const SparsePoint& point, int photograph) {
  return std::ranges::find(point.track, photograph, &TrackElement::image) != point.track.end();
}

// Whether a point is observed by the photograph whose viewing direction is closest to this one's.
// An occluder that belongs to the scene hides the point from that neighbour too. (So does a
// passer-by who stays for two photographs; the two cases are not distinguished.)
bool NeighbourObserves(const PosedImages& posed, int point, int photograph) {
  int neighbour = -1;
  double smallest = std::numeric_limits<double>::infinity();
  for (int other = 0; other < static_cast<int>(posed.images.size()); ++other) {
    if (other == photograph) continue;
    const double angle = AngleAt(posed, point, photograph, other);
    if (angle >= smallest || !ProjectInto(posed, other, posed.points[point].x_in_world)) continue;
    smallest = angle;
    neighbour = other;
  }
  return neighbour >= 0 && IsObservedBy(posed.points[point], neighbour);
}

// The points, with their pixels, that a photograph should observe but whose tracks do not include
// it (see TrackColors::unseen).
std::vector<std::pair<int, Vector2d>> ExpectedPoints(const PosedImages& posed, int photograph,
                                                     double nearby) {
  ObservedParts observed(posed.cameras[posed.images[photograph].camera]);
  std::vector<std::pair<int, Vector2d>> candidates;
  for (int p = 0; p < static_cast<int>(posed.points.size()); ++p) {
    const SparsePoint& point = posed.points[p];
    const auto in_track = std::ranges::find(point.track, photograph, &TrackElement::image);
    if (in_track != point.track.end()) {
      observed.Add(in_track->pixel);
      continue;
    }
    const auto pixel = ProjectInto(posed, photograph, point.x_in_world);
    if (!pixel) continue;
    const auto near = std::ranges::count_if(point.track, [&](const TrackElement& seen) {
      return AngleAt(posed, p, photograph, seen.image) < nearby;
    });
    if (near >= kFewestNearby) candidates.emplace_back(p, *pixel);
  }
  std::erase_if(candidates, [&](const auto& candidate) {
    return !observed.IsEmptyAround(candidate.second) ||
           !NeighbourObserves(posed, candidate.first, photograph);
  });
  return candidates;
}

}  // namespace

double AngleAt(const PosedImages& posed, int point, int photograph_a, int photograph_b) {
  const Vector3d& x = posed.points[point].x_in_world;
  const Vector3d a = CentreOf(posed, photograph_a) - x, b = CentreOf(posed, photograph_b) - x;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

TrackColors ReadTrackColors(const PosedImages& posed, double nearby,
                            const std::function<void(int)>& read) {
  const auto photographs = static_cast<int>(posed.images.size());
  std::vector<std::vector<std::pair<int, Vector2d>>> tracks(photographs);
  for (int p = 0; p < static_cast<int>(posed.points.size()); ++p) {
    for (const TrackElement& seen : posed.points[p].track) {
      tracks[seen.image].emplace_back(p, seen.pixel);
    }
  }
  std::vector<TrackColors> of_photograph(photographs);
  std::mutex counting;
  int count = 0;
  ParallelForEach(photographs, [&](std::int64_t i) {
    const auto photograph = static_cast<int>(i);
    const PosedImage& image = posed.images[photograph];
    Image pixels;
    try {
      pixels = ReadImage(image.path, image.upright_by_exif);
      if (!image.mask.empty()) {
        // Masked pixels are excluded, whatever the mask means.
        pixels = WithMask(pixels, ReadMaskOf(image, pixels));
      }
    } catch (const InputError&) {
      return;  // training reports and skips it
    }
    const bool may_clip = pixels.encoding == ColorEncoding::kSrgb;
    const Image linear = ToLinear(pixels);
    const auto add_sightings = [&](const auto& places, std::vector<Sighting>& into) {
      for (const auto& [point, pixel] : places) {
        if (const auto light = LightAt(linear, may_clip, pixel)) {
          into.push_back({point, photograph, light->log_light, light->contrast});
        }
      }
    };
    add_sightings(tracks[photograph], of_photograph[photograph].seen);
    add_sightings(ExpectedPoints(posed, photograph, nearby), of_photograph[photograph].unseen);
    const std::lock_guard lock(counting);
    if (read) read(++count);
  });
  TrackColors all;
  for (const TrackColors& part : of_photograph) {
    all.seen.insert(all.seen.end(), part.seen.begin(), part.seen.end());
    all.unseen.insert(all.unseen.end(), part.unseen.begin(), part.unseen.end());
  }
  return all;
}

}  // namespace nerf
