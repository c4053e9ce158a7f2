#include "sfm/pair_matching.h"

#include <algorithm>
#include <cmath>
#include <list>
#include <map>
#include <mutex>
#include <set>

#include "nerf/base/parallel.h"

namespace nerf::sfm {
namespace {

constexpr int kCoarseFeatures = 512, kFewestCoarse = 128;
constexpr double kManyPhotographs = 200;
constexpr std::size_t kPairsAtOnce = 64;
constexpr std::size_t kFeaturesKept = 300;  // photographs, 0.4 MB each

// The features of the photographs that were read last.
class FeatureCache {
 public:
  explicit FeatureCache(const ColmapDatabase& database) : database_(database) {}

  // Valid until as many others were read as are kept.
  const Features& Get(int image) {
    if (const auto found = features_.find(image); found != features_.end()) {
      order_.splice(order_.begin(), order_, found->second.second);
      return found->second.first;
    }
    if (features_.size() == kFeaturesKept) {
      features_.erase(order_.back());
      order_.pop_back();
    }
    order_.push_front(image);
    return features_.emplace(image, std::pair(database_.ReadFeatures(image), order_.begin()))
        .first->second.first;
  }

 private:
  const ColmapDatabase& database_;
  std::list<int> order_;  // last used first
  std::map<int, std::pair<Features, std::list<int>::iterator>> features_;
};

static_assert(kFeaturesKept >= 2 * kPairsAtOnce);

std::vector<FeatureMatch> Selected(const std::vector<FeatureMatch>& matches,
                                   const std::vector<int>& indices) {
  std::vector<FeatureMatch> selected;
  for (const int i : indices) selected.push_back(matches[i]);
  return selected;
}

}  // namespace

PairMatches MatchPair(ImagePair pair, const Features& first, const Features& second,
                      const EpipolarOptions& options) {
  PairMatches result{pair, MatchFeatures(first, second), {}};
  std::vector<PointPair> points;
  for (const FeatureMatch& match : result.matches) {
    points.push_back({first.positions[match.first].cast<double>(),
                      second.positions[match.second].cast<double>()});
  }
  const auto seed = static_cast<std::uint32_t>(pair.first * 40503 + pair.second);
  if (const auto geometry = FitEpipolarGeometry(points, options, seed)) {
    result.verified = Selected(result.matches, geometry->inliers);
    result.fundamental = geometry->fundamental;
  }
  return result;
}

std::vector<std::pair<ImagePair, int>> CompareAllPairs(
    const ColmapDatabase& database, int threads, const std::function<void(int done)>& progress) {
  const int count = static_cast<int>(database.Names().size());
  const int wanted = std::clamp(
      static_cast<int>(kCoarseFeatures * std::sqrt(kManyPhotographs / std::max(1, count))),
      kFewestCoarse, kCoarseFeatures);
  std::vector<Features> largest(count);
  for (int i = 0; i < count; ++i) largest[i] = LargestFeatures(database.ReadFeatures(i), wanted);
  std::mutex mutex;
  int done = 0;
  std::vector<std::pair<ImagePair, int>> similar;
  ParallelForEach(
      count,
      [&](std::int64_t item) {
        const int i = static_cast<int>(item);
        std::vector<std::pair<ImagePair, int>> own;
        for (int j = i + 1; j < count; ++j) {
          const PairMatches result = MatchPair({i, j}, largest[i], largest[j]);
          if (result.verified.empty()) continue;
          own.emplace_back(result.pair, static_cast<int>(result.verified.size()));
        }
        const std::scoped_lock lock(mutex);
        similar.insert(similar.end(), own.begin(), own.end());
        progress(++done);
      },
      threads);
  std::ranges::sort(similar);
  return similar;
}

void MatchPairs(ColmapDatabase& database, const std::vector<ImagePair>& pairs, int threads,
                const std::function<void(std::size_t done)>& progress) {
  const std::set<ImagePair> matched = database.MatchedPairs();
  std::vector<ImagePair> remaining;
  std::ranges::set_difference(pairs, matched, std::back_inserter(remaining));
  FeatureCache cache(database);
  const std::size_t before = pairs.size() - remaining.size();
  for (std::size_t begin = 0; begin < remaining.size(); begin += kPairsAtOnce) {
    const std::size_t count = std::min(kPairsAtOnce, remaining.size() - begin);
    std::vector<std::pair<const Features*, const Features*>> features;
    for (std::size_t i = 0; i < count; ++i) {
      const ImagePair& pair = remaining[begin + i];
      const Features* const first = &cache.Get(pair.first);
      features.emplace_back(first, &cache.Get(pair.second));
    }
    std::vector<PairMatches> results(count);
    ParallelForEach(
        static_cast<std::int64_t>(count),
        [&](std::int64_t i) {
          results[i] = MatchPair(remaining[begin + i], *features[i].first, *features[i].second);
        },
        threads);
    database.Write(results);
    progress(before + begin + count);
  }
}

}  // namespace nerf::sfm
