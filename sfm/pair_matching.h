#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "sfm/colmap_database.h"
#include "sfm/epipolar_geometry.h"

namespace nerf::sfm {

// Matches the features of two photographs and verifies them by the epipolar geometry.
PairMatches MatchPair(ImagePair pair, const Features& first, const Features& second,
                      const EpipolarOptions& options = {});

// Compares all photographs by few features of each, the largest: 512 of up to 200 photographs,
// fewer of more, so that the time for each photograph stays about constant.
//   threads   0: NumThreads()
//   progress  called with the number of photographs done, one call at a time
//   returns   pairs with verified matches, and their number
std::vector<std::pair<ImagePair, int>> CompareAllPairs(
    const ColmapDatabase& database, int threads, const std::function<void(int done)>& progress);

// Matches pairs by all their features and writes the results to the database in parts, so that an
// interrupted call continues: pairs that are there are skipped. In memory are the features of a few
// hundred photographs.
//   pairs     sorted
//   progress  called with the number of pairs done
void MatchPairs(ColmapDatabase& database, const std::vector<ImagePair>& pairs, int threads,
                const std::function<void(std::size_t done)>& progress);

}  // namespace nerf::sfm
