#include "nerf/effects/geometry_verdicts.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <vector>

#include "nerf/base/quantile.h"
#include "nerf/sampling/ray_marcher.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {
namespace {

// From which on a scene calls for an effect.
constexpr double kBall = 1.5;  // radii; of a larger one the middle is finer where space contracts
constexpr double kBetween = 0.005;      // share of points that may stand before a background
constexpr double kRoom = 1.2;           // about the near points, for what has none
constexpr double kFarAway = 0.007;      // share of points beyond kFar
constexpr double kFar = 8;              // radii of what the cameras look at
constexpr double kFewPhotographs = 15;  // before which a point stands
constexpr double kWrongPixels = 1.25;   // median over sightings, pixels of the photographs
constexpr double kScales = 2.2;         // largest over smallest of a point, median over sightings
constexpr double kOneEnd = 0.1, kOtherEnd = 0.9;  // of a point's scales, between which they count
constexpr double kNearest = 0.01;       // share of sightings that may be nearer than "the nearest"
constexpr double kShareOfTheWay = 0.7;  // to them, in which nothing stands

}  // namespace

Verdict JudgeUnbounded(const std::optional<Ball>& hull) {
  if (!hull) return Fact("unbounded", true, 0, "what alpha leaves may reach beyond 2 radii");
  return Fact(
      "unbounded", hull->radius > kBall, hull->radius,
      fmt::format("what alpha leaves is in a ball of {:.2f} radii; up to {:.1f} need no more",
                  hull->radius, kBall));
}

PointShares SharesOfPoints(const PosedImages& posed,
                           const SceneNormalization& normalized_from_world) {
  PointShares shares;
  std::vector<Eigen::Vector3d> near;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(kFar), high = -low;
  const double each = 1 / static_cast<double>(posed.points.size());
  for (const SparsePoint& point : posed.points) {
    const Eigen::Vector3d x = normalized_from_world.NormalizedFromWorld(point.x_in_world);
    if (x.norm() > kFar) {
      shares.far += each;
    } else if (x.norm() > kBall) {
      shares.between += each;
    } else {
      near.push_back(x);
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
  }
  if (near.empty()) return shares;
  shares.near = {(low + high) / 2, 0};
  for (const Eigen::Vector3d& x : near) {
    shares.near.radius = std::max(shares.near.radius, kRoom * (x - shares.near.centre).norm());
  }
  return shares;
}

bool IsBeforeBackground(const PointShares& shares) {
  return shares.far >= kFarAway && shares.between < kBetween && shares.far + shares.between < 1;
}

Verdict JudgeUnbounded(const PointShares& shares, bool learned) {
  const bool bounded = learned && IsBeforeBackground(shares);
  return Fact("unbounded", !bounded, shares.between,
              fmt::format("{:.1f} % of the points are from {:.1f} to {:.0f} radii away{}",
                          100 * shares.between, kBall, kFar,
                          bounded ? ": nothing before the background" : ""));
}

Verdict JudgeBackground(const PointShares& shares) {
  const Verdict verdict = Measured(
      "background", shares.far, kFarAway,
      fmt::format("{:.1f} % of the points are more than {:.0f} radii away; {:.1f} % call for it{}",
                  100 * shares.far, kFar, 100 * kFarAway,
                  shares.far >= kFarAway && !IsBeforeBackground(shares)
                      ? ", but contracted space holds them with those before them"
                      : ""));
  // Both are decided together, so one is as sure as the other.
  if (!verdict.on) return verdict;
  return Fact("background", IsBeforeBackground(shares), shares.far, verdict.evidence);
}

Verdict JudgeDepth(const PosedImages& posed, const SceneNormalization& normalized_from_world) {
  std::vector<double> photographs;
  for (const SparsePoint& point : posed.points) {
    if (normalized_from_world.NormalizedFromWorld(point.x_in_world).norm() > kFar) continue;
    int before = 0;
    for (const PosedImage& image : posed.images) {
      const Camera& camera = posed.cameras[image.camera];
      const auto pixel =
          PixelFromPoint(camera, image.world_from_camera.inverse() * point.x_in_world);
      before += pixel && pixel->x() >= 0 && pixel->y() >= 0 && pixel->x() < camera.width &&
                pixel->y() < camera.height;
    }
    photographs.push_back(before);
  }
  if (photographs.empty()) return Undecided("depth", "all points are far away");
  const double median = Quantile(photographs, 0.5);
  Verdict verdict =
      Fact("depth", median < kFewPhotographs, median,
           fmt::format("a point stands before {:.0f} photographs; fewer than {:.0f} call for it",
                       median, kFewPhotographs));
  verdict.threshold = kFewPhotographs;
  return verdict;
}

Verdict JudgePoses(const PosedImages& posed) {
  std::vector<double> pixels;
  for (const SparsePoint& point : posed.points) {
    for (const TrackElement& seen : point.track) {
      const PosedImage& image = posed.images[seen.image];
      const auto pixel = PixelFromPoint(posed.cameras[image.camera],
                                        image.world_from_camera.inverse() * point.x_in_world);
      if (pixel) pixels.push_back((*pixel - seen.pixel).norm());
    }
  }
  if (pixels.empty()) return Undecided("poses", "no sightings of points to tell from");
  const double median = Quantile(pixels, 0.5);
  return Measured("poses", median, kWrongPixels,
                  fmt::format("points are seen {:.2f} pixels from where the poses put them; {:.2f} "
                              "call for it",
                              median, kWrongPixels));
}

Verdict JudgeFootprint(const PosedImages& posed) {
  std::vector<double> ratios;  // of each sighting: what many photographs see counts more
  for (const SparsePoint& point : posed.points) {
    std::vector<double> footprints;  // of a pixel at the point, world units
    for (const TrackElement& seen : point.track) {
      const PosedImage& image = posed.images[seen.image];
      const double distance = (point.x_in_world - image.world_from_camera.translation()).norm();
      footprints.push_back(distance / FocalLength(posed.cameras[image.camera]));
    }
    const double smallest = Quantile(footprints, kOneEnd);
    if (smallest > 0) {
      const double ratio = Quantile(footprints, kOtherEnd) / smallest;
      ratios.insert(ratios.end(), point.track.size(), ratio);
    }
  }
  if (ratios.empty()) return Undecided("footprint", "no sightings of points to tell from");
  const double median = Quantile(ratios, 0.5);
  return Measured("footprint", median, kScales,
                  fmt::format("photographs show a point at scales {:.1f} to 1 apart; {:.1f} to 1 "
                              "call for it",
                              median, kScales));
}

Verdict JudgeNear(const PosedImages& posed, const SceneNormalization& normalized_from_world) {
  std::vector<double> distances;
  for (const SparsePoint& point : posed.points) {
    for (const TrackElement& seen : point.track) {
      const Eigen::Vector3d camera = posed.images[seen.image].world_from_camera.translation();
      distances.push_back(normalized_from_world.scale * (point.x_in_world - camera).norm());
    }
  }
  const double nearest = Quantile(distances, kNearest);
  const double near = std::clamp(kShareOfTheWay * nearest, MarchOptions().near_distance, kFar);
  Verdict verdict = Fact("near", near > MarchOptions().near_distance, near,
                         fmt::format("the nearest points are {:.2f} radii before a camera, so rays "
                                     "begin at {:.2f}",
                                     nearest, near));
  verdict.assignment = fmt::format("{}={:.3f}", kNearKey, near);
  return verdict;
}

}  // namespace nerf
