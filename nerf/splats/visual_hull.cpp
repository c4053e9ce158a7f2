#include "nerf/splats/visual_hull.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "nerf/base/parallel.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

constexpr int kMostPixels = 256;  // of a side of a silhouette
constexpr float kOpaque = 0.5f;
constexpr int kFirstSide = 64, kMostSide = 256;  // of the cube, voxels
// Of the photographs so many have to look at a voxel: what is close to one camera is outside the
// pictures of others, which cannot see through it.
constexpr double kLeastShare = 0.5;

// A photograph at a resolution that suits the voxels.
class Silhouette {
 public:
  explicit Silhouette(const TargetView& view)
      : reduced_(Reduced(view, HalvingsOf(view.camera))), picture_(TargetOf(reduced_)) {}

  // Red, green, blue and opacity at a point; nullopt where it is not in the picture.
  std::optional<Eigen::Vector4f> At(const Eigen::Vector3d& x_in_normalized) const {
    const auto pixel = PixelFromPoint(reduced_.camera,
                                      reduced_.normalized_from_camera.inverse() * x_in_normalized);
    if (!pixel) return std::nullopt;
    const double x = std::floor(pixel->x()), y = std::floor(pixel->y());
    if (!(x >= 0 && y >= 0 && x < picture_.width && y < picture_.height)) return std::nullopt;
    const auto at = [&](int plane) {
      return picture_.Row(plane, static_cast<int>(y))[static_cast<int>(x)];
    };
    if (at(TargetPicture::kWeight) == 0) return std::nullopt;
    return Eigen::Vector4f(at(0), at(1), at(2), at(TargetPicture::kOpacity));
  }

 private:
  static int HalvingsOf(const Camera& camera) {
    int halvings = 0;
    while (std::max(camera.width, camera.height) >> halvings > kMostPixels) ++halvings;
    return halvings;
  }

  TargetView reduced_;
  TargetPicture picture_;
};

// The voxels of a cube of [-1, 1]^3: those that no photograph sees through are inside.
class Voxels {
  enum Found : char { kUnknown, kInside, kEmpty };

 public:
  Voxels(const std::vector<Silhouette>& silhouettes, int side)
      : silhouettes_(silhouettes), side_(side), found_(std::size_t(1) * side * side * side) {
    ParallelForEach(side, [&](std::int64_t z) {
      for (int y = 0; y < side_; ++y) {
        for (int x = 0; x < side_; ++x) {
          found_[Index(x, y, static_cast<int>(z))] = LookAt(Center(x, y, static_cast<int>(z)));
        }
      }
    });
  }

  // The centres of those that are inside beside one that is empty.
  std::vector<Eigen::Vector3d> Border() const {
    std::vector<Eigen::Vector3d> border;
    for (int z = 0; z < side_; ++z) {
      for (int y = 0; y < side_; ++y) {
        for (int x = 0; x < side_; ++x) {
          if (At(x, y, z) != kInside) continue;
          const Found beside[] = {At(x - 1, y, z), At(x + 1, y, z), At(x, y - 1, z),
                                  At(x, y + 1, z), At(x, y, z - 1), At(x, y, z + 1)};
          if (std::ranges::count(beside, kEmpty) > 0) border.push_back(Center(x, y, z));
        }
      }
    }
    return border;
  }

 private:
  std::size_t Index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * side_ + y) * side_ + x;
  }
  Eigen::Vector3d Center(int x, int y, int z) const {
    return (Eigen::Vector3d(x, y, z).array() + 0.5) * 2 / side_ - 1;
  }
  Found At(int x, int y, int z) const {
    const auto is_within = [&](int k) { return k >= 0 && k < side_; };
    return is_within(x) && is_within(y) && is_within(z) ? found_[Index(x, y, z)] : kUnknown;
  }
  Found LookAt(const Eigen::Vector3d& point) const {
    int seen = 0;
    for (const Silhouette& silhouette : silhouettes_) {
      const auto value = silhouette.At(point);
      if (!value) continue;
      if ((*value)[3] < kOpaque) return kEmpty;
      ++seen;
    }
    const double least = kLeastShare * static_cast<double>(silhouettes_.size());
    return seen > 0 && seen >= least ? kInside : kUnknown;
  }

  const std::vector<Silhouette>& silhouettes_;
  int side_;
  std::vector<Found> found_;
};

Eigen::Vector3f MeanColor(const std::vector<Silhouette>& silhouettes,
                          const Eigen::Vector3d& point) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float count = 0;
  for (const Silhouette& silhouette : silhouettes) {
    const auto value = silhouette.At(point);
    if (!value) continue;
    sum += value->head<3>();
    ++count;
  }
  return sum / count;
}

}  // namespace

std::vector<ColoredPoint> VisualHull(const std::vector<TargetView>& views, std::int64_t wanted) {
  std::vector<Silhouette> silhouettes;
  for (const TargetView& view : views) silhouettes.emplace_back(view);
  std::vector<Eigen::Vector3d> border;
  int side = kFirstSide / 2;
  while (border.empty() && side < kMostSide) {  // what is thin has no centre of a large voxel
    side *= 2;
    border = Voxels(silhouettes, side).Border();
  }
  if (border.empty()) return {};
  // A border grows with the square of the side.
  const double growth = static_cast<double>(wanted) / static_cast<double>(border.size());
  const auto fitting =
      static_cast<int>(std::clamp<double>(std::lround(side * std::sqrt(growth)), 8, kMostSide));
  std::vector<Eigen::Vector3d> finer = Voxels(silhouettes, fitting).Border();
  if (!finer.empty()) border = std::move(finer);
  std::vector<ColoredPoint> points(border.size());
  ParallelFor(static_cast<std::int64_t>(border.size()), 256,
              [&](std::int64_t first, std::int64_t last) {
                for (std::int64_t i = first; i < last; ++i) {
                  points[i] = {border[i], MeanColor(silhouettes, border[i])};
                }
              });
  return points;
}

}  // namespace nerf
