#include "nerf/inspect/exif_stops.h"

#include <spdlog/fmt/fmt.h>

#include <numeric>
#include <optional>

#include "nerf/image/exif_exposure.h"

namespace nerf {

ExifStops ReadExifStops(const PosedImages& posed) {
  ExifStops all;
  for (const PosedImage& image : posed.images) {
    const std::optional<ExifExposure> exposure = ReadExifExposure(image.path);
    if (!exposure) return {};
    if (!exposure->contradiction.empty()) {
      return {{},
              fmt::format("{}: EXIF {}; no exposure from EXIF is used; fix or remove the entry",
                          image.path.string(), exposure->contradiction)};
    }
    all.stops.push_back(exposure->stops);
  }
  const double mean = std::accumulate(all.stops.begin(), all.stops.end(), 0.0) /
                      static_cast<double>(all.stops.size());
  for (double& stops : all.stops) stops -= mean;
  return all;
}

}  // namespace nerf
