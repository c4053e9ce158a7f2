#include "sfm/colmap_estimate.h"

#include <algorithm>
#include <cmath>

namespace nerf::sfm {
namespace {

// Seconds of one core. Measured with COLMAP 3.8 on 50 photographs of 1080x1920: features 11 s,
// guided matches 2.4 s, mapper 10 s; and on 36 of 400x300: 2.6 s, 0.4 s, 1.3 s; on two cores each.
constexpr double kFeaturesPerMegapixel = 0.3;
constexpr int kEnlarged = 1200;  // smaller photographs are enlarged by two, as in ColmapSteps
constexpr double kMatchPerPair = 0.013;  // of 2048 features each; grows with their product
constexpr double kUsualFeatures = 2048;
constexpr double kFullMegapixels = 0.6;  // smaller photographs have fewer features
constexpr double kMapping = 0.09;  // per photograph of few; more of them need more adjustments
constexpr double kManyPhotographs = 25;
constexpr double kGrowth = 0.7;

// As ColmapSteps matches: all by 512 features, and twelve partners of each by all of theirs.
constexpr double kCoarseCost = (512 / kUsualFeatures) * (512 / kUsualFeatures);
constexpr double kManyCompared = 200;  // of more photographs fewer features are compared
constexpr int kPartners = 12, kPairsInSequence = 25, kExhaustiveMost = 20;

double MegapixelsOf(int longest_side, const ColmapOptions& options) {
  const double side = std::min(longest_side, options.max_image_size);
  return 0.75 * side * side * 1e-6;
}

double FeaturesOf(int longest_side, const ColmapOptions& options) {
  return options.max_num_features *
         std::min(1.0, std::sqrt(MegapixelsOf(longest_side, options) / kFullMegapixels));
}

}  // namespace

double EstimatePointSeconds(int photographs, int longest_side, const ColmapOptions& options,
                            int threads) {
  const double count = photographs, pairs = count * (count - 1) / 2;
  const double megapixels = MegapixelsOf(longest_side, options);
  double matched = pairs;
  if (options.matcher == "sequential") {
    matched = std::min(pairs, kPairsInSequence * count);
  } else if (options.matcher != "exhaustive" && photographs > kExhaustiveMost) {
    matched = kCoarseCost * std::min(1.0, kManyCompared / count) * pairs +
              std::min(pairs, kPartners * count);
  }
  const double features = FeaturesOf(longest_side, options);
  const double per_pair = kMatchPerPair * std::pow(features / kUsualFeatures, 2);
  const bool is_enlarged = std::min(longest_side, options.max_image_size) < kEnlarged;
  const double searched = megapixels * (is_enlarged ? 4 : 1);
  return (kFeaturesPerMegapixel * searched * count + per_pair * matched) / std::max(1, threads);
}

double EstimatePoseSeconds(int photographs, int longest_side, const ColmapOptions& options,
                           int threads) {
  const double count = photographs;
  return EstimatePointSeconds(photographs, longest_side, options, threads) +
         kMapping * FeaturesOf(longest_side, options) / kUsualFeatures * count *
             std::pow(std::max(1.0, count / kManyPhotographs), kGrowth);
}

}  // namespace nerf::sfm
