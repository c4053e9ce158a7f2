#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace nerf::sfm {

// The SIFT features of one photograph.
struct Features {
  std::vector<Eigen::Vector2f> positions;  // pixels, as COLMAP counts them: the first centre is 0.5
  std::vector<float> scales;               // pixels
  std::vector<std::uint8_t> descriptors;   // [count][kernels::kDescriptorSize], length 512

  int Count() const { return static_cast<int>(positions.size()); }
};

// The `count` features of largest scale: these are matched most often (Wu 2013, "Towards
// Linear-Time Incremental Structure from Motion", section 3), and few are matched quickly.
Features LargestFeatures(const Features& features, int count);

// Two features, one of each photograph, that show the same point.
struct FeatureMatch {
  std::uint32_t first = 0, second = 0;

  bool operator==(const FeatureMatch&) const = default;
};

// Matches features that are each other's nearest by the angle of their descriptors, where that is
// at most 0.7 radian and less than 0.8 of the angle to the second nearest, in both directions.
// The rules and figures of COLMAP's matcher, but exact, where COLMAP 3.8 searches approximately.
//   returns  sorted by `first`
std::vector<FeatureMatch> MatchFeatures(const Features& first, const Features& second);

}  // namespace nerf::sfm
