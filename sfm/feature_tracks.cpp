#include "sfm/feature_tracks.h"

#include <algorithm>
#include <numeric>

namespace nerf::sfm {
namespace {

// Disjoint sets with path halving (Tarjan and van Leeuwen 1984).
class DisjointSets {
 public:
  explicit DisjointSets(int count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int Find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void Join(int a, int b) {
    const int of_a = Find(a), of_b = Find(b);
    parent_[std::max(of_a, of_b)] = std::min(of_a, of_b);
  }

 private:
  std::vector<int> parent_;
};

FeatureTrack WithoutConflicts(const FeatureTrack& track) {
  FeatureTrack kept;
  for (std::size_t i = 0; i < track.size();) {
    std::size_t end = i + 1;
    while (end < track.size() && track[end].image == track[i].image) ++end;
    if (end == i + 1) kept.push_back(track[i]);
    i = end;
  }
  return kept;
}

}  // namespace

std::vector<FeatureTrack> BuildTracks(
    std::span<const std::pair<ImagePair, std::vector<FeatureMatch>>> matches,
    std::span<const int> features, std::size_t fewest) {
  std::vector<int> first(features.size() + 1, 0);  // number of the first feature of a photograph
  std::partial_sum(features.begin(), features.end(), first.begin() + 1);
  DisjointSets sets(first.back());
  for (const auto& [pair, of_pair] : matches) {
    for (const FeatureMatch& match : of_pair) {
      sets.Join(first[pair.first] + static_cast<int>(match.first),
                first[pair.second] + static_cast<int>(match.second));
    }
  }
  std::vector<FeatureTrack> all(first.back());
  for (int image = 0; image < static_cast<int>(features.size()); ++image) {
    for (int feature = 0; feature < features[image]; ++feature) {
      all[sets.Find(first[image] + feature)].push_back({image, feature});
    }
  }
  std::vector<FeatureTrack> tracks;
  for (const FeatureTrack& track : all) {
    if (track.size() < fewest) continue;
    FeatureTrack kept = WithoutConflicts(track);
    if (kept.size() >= fewest) tracks.push_back(std::move(kept));
  }
  return tracks;
}

}  // namespace nerf::sfm
