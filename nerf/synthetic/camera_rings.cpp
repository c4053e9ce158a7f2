#include "nerf/synthetic/camera_rings.h"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "nerf/output/camera_path.h"
#include "nerf/scene/camera.h"
#include "nerf/synthetic/hash.h"
#include "nerf/synthetic/scenario.h"

namespace nerf::synthetic {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kVerticalFov = 40 * kDegree;
constexpr double kDistance = 3.0;                      // scene units
const Vector3d kSubject(0, 0, 0.25);                   // where the cameras look
const std::vector<double> kElevations = {14, 34, 56};  // degrees

// A stream of random numbers in [-1, 1).
class Irregularity {
 public:
  explicit Irregularity(unsigned seed) : seed_(seed) {}
  double Next() { return 2 * UnitFromHash(Hash(count_++, 0, 0, seed_)) - 1; }
  Vector3d NextPoint() {
    const double x = Next(), y = Next(), z = Next();
    return {x, y, z};
  }

 private:
  unsigned seed_;
  int count_ = 0;
};

// Few views share one ring, so that neighbours are still close to each other.
std::vector<double> RingElevations(int views) {
  if (views < 12) return {25};
  if (views < 24) return {18, 42};
  return kElevations;
}

// The number of views on each ring, in proportion to its circumference.
std::vector<int> ViewsOnRings(int views, const std::vector<double>& elevations) {
  double total = 0;
  for (const double elevation : elevations) total += std::cos(elevation * kDegree);
  std::vector<int> counts;
  double share = 0;  // of this ring and those before
  int assigned = 0;
  for (const double elevation : elevations) {
    share += std::cos(elevation * kDegree) / total;
    const int up_to_here = static_cast<int>(std::lround(views * share));
    counts.push_back(up_to_here - assigned);
    assigned = up_to_here;
  }
  return counts;
}

}  // namespace

PosedImages CameraRings(const SampleOptions& options) {
  options.Check();
  PosedImages posed;
  posed.cameras = {PinholeFromFov(options.width, options.height, kVerticalFov)};
  Irregularity irregular(options.seed);
  const std::vector<double> elevations = RingElevations(options.views);
  const std::vector<int> counts = ViewsOnRings(options.views, elevations);
  for (std::size_t ring = 0; ring < elevations.size(); ++ring) {
    const double start =
        137.5 * static_cast<double>(ring);  // so that no view is straight above another
    for (int i = 0; i < counts[ring]; ++i) {
      const double azimuth = AzimuthIn(
          options.scenario, (start + 360.0 * i / counts[ring] + 2 * irregular.Next()) * kDegree);
      const double elevation = (elevations[ring] + 2 * irregular.Next()) * kDegree;
      const auto view = static_cast<int>(posed.images.size());
      const double distance =
          kDistance * DistanceFactor(options.scenario, view) * (1 + 0.05 * irregular.Next());
      const Vector3d position =
          distance * Vector3d(std::cos(azimuth) * std::cos(elevation),
                              std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
      const Vector3d target = kSubject + 0.08 * irregular.NextPoint();
      PosedImage image;
      image.name =
          fmt::format("view_{:03}.{}", view, options.scenario == Scenario::kHdr ? "exr" : "png");
      const Eigen::AngleAxisd roll(3 * kDegree * irregular.Next(), Vector3d::UnitZ());
      image.world_from_camera = LookAt(position, target, Vector3d::UnitZ()) * roll;
      posed.images.push_back(image);
    }
  }
  return posed;
}

}  // namespace nerf::synthetic
