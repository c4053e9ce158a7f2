#pragma once

#include <span>
#include <utility>
#include <vector>

#include "sfm/colmap_database.h"

namespace nerf::sfm {

struct FeatureOfImage {
  int image = 0, feature = 0;

  auto operator<=>(const FeatureOfImage&) const = default;
};

// Features of different photographs that are matched with each other, directly or over others:
// what probably shows one point. Sorted, at most one feature of each photograph: where matches
// lead to several of one photograph, these are left out.
using FeatureTrack = std::vector<FeatureOfImage>;

//   features  their number in each photograph
//   fewest    shorter tracks are left out
std::vector<FeatureTrack> BuildTracks(
    std::span<const std::pair<ImagePair, std::vector<FeatureMatch>>> matches,
    std::span<const int> features, std::size_t fewest);

}  // namespace nerf::sfm
