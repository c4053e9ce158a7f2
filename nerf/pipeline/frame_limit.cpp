#include "nerf/pipeline/frame_limit.h"

#include <algorithm>
#include <limits>

#include "nerf/base/quantile.h"
#include "nerf/base/stopwatch.h"
#include "nerf/splats/gaussian_camera.h"

namespace nerf {
namespace {

constexpr std::size_t kFrames = 8;
// The least of so many counts: nothing that is left out comes back, and others use the machine too.
constexpr int kMeasurements = 3;
// At once at most so many are left out; the others have to take their place.
constexpr double kLeastShare = 0.7;
constexpr std::int64_t kFewestKept = 16;

}  // namespace

double SecondsPerFrame(const GaussianCloud& cloud, const std::vector<TargetView>& views,
                       double near) {
  GaussianRenderer renderer;
  std::vector<double> seconds;
  const std::size_t count = std::min(kFrames, views.size());
  for (std::size_t i = 0; i <= count; ++i) {
    const TargetView& view = views[i % count * views.size() / count];
    const kernels::GaussianCamera camera =
        MakeGaussianCamera(view.camera, view.normalized_from_camera, near);
    const Stopwatch watch;
    renderer.Draw(camera, cloud.Parameters());
    if (i > 0) seconds.push_back(watch.Seconds());  // the first one allocates
  }
  return Median(seconds);
}

void KeepToFrameTime(GaussianFit& fit, const std::vector<TargetView>& views, double near,
                     double seconds) {
  double taken = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMeasurements && taken > seconds; ++i) {
    taken = std::min(taken, SecondsPerFrame(fit.Cloud(), views, near));
  }
  if (taken <= seconds) return;
  const double share = std::max(kLeastShare, seconds / taken);
  const auto count = static_cast<std::int64_t>(share * static_cast<double>(fit.Cloud().count));
  fit.Keep(std::max(kFewestKept, count));
}

}  // namespace nerf
