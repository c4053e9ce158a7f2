#include "nerf/light/units.h"

#include <numeric>

namespace nerf {

double LuminousEfficacy(const Spectrum& spectrum) {
  const double watts =
      std::accumulate(spectrum.values.begin(), spectrum.values.end(), 0.0) * Spectrum::kStep;
  return watts > 0 ? kEfficacy * XyzFromSpectrum(spectrum).y() / watts : 0;
}

}  // namespace nerf
