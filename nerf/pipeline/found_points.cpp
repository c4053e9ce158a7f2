#include "nerf/pipeline/found_points.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "sfm/colmap_estimate.h"
#include "sfm/colmap_program.h"

namespace nerf {

constexpr int kSmallest = 100;  // pixels; smaller photographs have hardly any features

void FindMissingPoints(PosedImages& posed, const std::filesystem::path& folder, double most_seconds,
                       const PipelineListener& listener) {
  if (!posed.points.empty() || posed.images.size() < 3) return;
  int longest_side = 0;
  for (const Camera& camera : posed.cameras) {
    longest_side = std::max({longest_side, camera.width, camera.height});
  }
  if (longest_side < kSmallest) return;
  sfm::ColmapOptions options;
  options.threads = NumThreads();
  const double seconds = sfm::EstimatePointSeconds(static_cast<int>(posed.images.size()),
                                                   longest_side, options, options.threads);
  if (seconds > most_seconds || !sfm::ColmapProgram::IsInstalled()) return;
  MakeOutputFolder(folder);  // may fail, other than what follows
  try {
    const sfm::SparsePointReport report = sfm::FindSparsePoints(posed, folder, options);
    if (report.consistency.IsDoubtful()) {
      listener(
          Warning{fmt::format("{}: {}", posed.source.string(), sfm::Describe(report.consistency))});
    }
    if (report.points > 0) listener(PointsFound{report});
    if (report.points == 0 && !report.consistency.IsDoubtful()) {
      listener(Warning{fmt::format("{}: no sparse points: {}", posed.source.string(),
                                   sfm::Describe(report.consistency))});
    }
  } catch (const InputError& error) {
    listener(Warning{fmt::format("no sparse points: {}", error.what())});
  }
}

}  // namespace nerf
