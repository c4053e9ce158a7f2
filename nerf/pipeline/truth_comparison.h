#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "nerf/model/materials_file.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/truth_folder.h"

namespace nerf {

// How near pictures are to the truth of held-out views. Absent where there is no truth of it.
struct TruthScores {
  std::optional<double> normal_degrees;  // mean angle, over pixels that the truth has
  std::optional<double> albedo_psnr;     // dB, sRGB, on white, with the scale
  std::optional<double> albedo_psnr_unscaled;
  std::array<double, 3> scale = {1, 1, 1};   // of the albedo, median of truth over what was found
  std::optional<double> roughness_error;     // mean difference
  std::map<std::string, double> relit_psnr;  // dB by light, with the scale on the albedo
};

struct TruthComparison {
  std::int64_t views = 0;
  TruthScores found;
  // What the field says without taking it apart: normals of its density's gradient, its pictures,
  // linear, as the albedo, and as the relit views.
  TruthScores trivial;
  double light_seconds = 0;  // for bounces under a light, mean
  double view_seconds = 0;   // for a view, mean
};

// Compares the held-out views of a run with the truth of a scene by the protocol of TensoIR (Jin et
// al. 2023): pixels that are not opaque are before white; one scale a channel for all views.
//   bounces   of relit views
//   progress  called with the views and lights done, and how many there are
// Throws InputError where no held-out view has truth, or truth has another size.
TruthComparison CompareWithTruth(
    const OpenedRun& run, Materials materials, const TruthFolder& truth, int bounces,
    const std::function<void(std::size_t done, std::size_t of)>& progress);

}  // namespace nerf
