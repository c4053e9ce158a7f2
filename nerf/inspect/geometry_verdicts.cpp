#include "nerf/inspect/geometry_verdicts.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <vector>

#include "nerf/config.h"
#include "nerf/data/camera.h"
#include "nerf/inspect/photograph_fit.h"
#include "sfm/scene_normalization.h"

namespace nerf {
namespace {

// From which on a scene calls for an effect.
constexpr double kBall = 1.5;  // radii; of a larger one the middle is finer where space contracts
constexpr double kFarAway = 0.007;      // share of points beyond kFar
constexpr double kFar = 8;              // radii of what the cameras look at
constexpr double kFewPhotographs = 15;  // before which a point stands
constexpr double kWrongPixels = 1.25;   // median over sightings, pixels of the photographs
constexpr double kScales = 2.2;         // largest over smallest of a point, median over sightings
constexpr double kOneEnd = 0.1, kOtherEnd = 0.9;  // of a point's scales, between which they count
constexpr double kNearest = 0.01;       // share of sightings that may be nearer than "the nearest"
constexpr double kShareOfTheWay = 0.7;  // to them, in which nothing stands

}  // namespace

Verdict JudgeUnbounded(bool alpha, const std::optional<Ball>& hull) {
  if (!alpha) return Fact("unbounded", true, 0, "photographs without alpha show surroundings");
  if (!hull) return Fact("unbounded", true, 0, "what alpha leaves may reach beyond 2 radii");
  return Fact(
      "unbounded", hull->radius > kBall, hull->radius,
      fmt::format("what alpha leaves is in a ball of {:.2f} radii; up to {:.1f} need no more",
                  hull->radius, kBall));
}

Verdict JudgeBackground(const sfm::PosedImages& posed,
                        const sfm::SceneNormalization& normalized_from_world) {
  std::size_t far = 0;
  for (const sfm::SparsePoint& point : posed.points) {
    if (normalized_from_world.NormalizedFromWorld(point.x_in_world).norm() > kFar) ++far;
  }
  const double share = static_cast<double>(far) / static_cast<double>(posed.points.size());
  return Measured("background", share, kFarAway,
                  fmt::format("{:.1f} % of the points are more than {:.0f} radii away; {:.1f} % "
                              "call for it",
                              100 * share, kFar, 100 * kFarAway));
}

Verdict JudgeDepth(const sfm::PosedImages& posed) {
  std::vector<double> photographs;
  for (const sfm::SparsePoint& point : posed.points) {
    int before = 0;
    for (const sfm::PosedImage& image : posed.images) {
      const sfm::Camera& camera = posed.cameras[image.camera];
      const auto pixel =
          PixelFromPoint(camera, image.world_from_camera.inverse() * point.x_in_world);
      before += pixel && pixel->x() >= 0 && pixel->y() >= 0 && pixel->x() < camera.width &&
                pixel->y() < camera.height;
    }
    photographs.push_back(before);
  }
  const double median = Quantile(photographs, 0.5);
  Verdict verdict =
      Fact("depth", median < kFewPhotographs, median,
           fmt::format("a point stands before {:.0f} photographs; fewer than {:.0f} call for it",
                       median, kFewPhotographs));
  verdict.threshold = kFewPhotographs;
  return verdict;
}

Verdict JudgePoses(const sfm::PosedImages& posed) {
  std::vector<double> pixels;
  for (const sfm::SparsePoint& point : posed.points) {
    for (const sfm::TrackElement& seen : point.track) {
      const sfm::PosedImage& image = posed.images[seen.image];
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

Verdict JudgeFootprint(const sfm::PosedImages& posed) {
  std::vector<double> ratios;  // of each sighting: what many photographs see counts more
  for (const sfm::SparsePoint& point : posed.points) {
    std::vector<double> footprints;  // of a pixel at the point, world units
    for (const sfm::TrackElement& seen : point.track) {
      const sfm::PosedImage& image = posed.images[seen.image];
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

Verdict JudgeNear(const sfm::PosedImages& posed,
                  const sfm::SceneNormalization& normalized_from_world) {
  std::vector<double> distances;
  for (const sfm::SparsePoint& point : posed.points) {
    for (const sfm::TrackElement& seen : point.track) {
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
