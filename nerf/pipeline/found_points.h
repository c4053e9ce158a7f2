#pragma once

#include <filesystem>

#include "nerf/pipeline/events.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// Finds sparse points, which most verdicts on effects need, for a capture that has poses but none,
// if that takes at most so many seconds, roughly. Reports PointsFound, or a Warning where it cannot
// be done or the photographs contradict the poses; neither stops the work. Throws InputError if the
// folder cannot be created.
//   folder  for COLMAP's files: a second call with the same photographs skips what is done
void FindMissingPoints(PosedImages& posed, const std::filesystem::path& folder, double most_seconds,
                       const PipelineListener& listener);

}  // namespace nerf
