#include "sfm/pair_selection.h"

#include <algorithm>
#include <set>

namespace nerf::sfm {

std::vector<ImagePair> AllPairs(int count) {
  std::vector<ImagePair> pairs;
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) pairs.push_back({i, j});
  }
  return pairs;
}

std::vector<ImagePair> SequentialPairs(int count, int overlap) {
  std::set<ImagePair> pairs;
  for (int i = 0; i < count; ++i) {
    for (int k = 1; k <= overlap && i + k < count; ++k) pairs.insert({i, i + k});
    for (int k = 0; k < std::min(overlap, 30) && i + (1 << k) < count; ++k) {
      pairs.insert({i, i + (1 << k)});
    }
  }
  return {pairs.begin(), pairs.end()};
}

std::vector<ImagePair> MostSimilarPairs(const std::vector<std::pair<ImagePair, int>>& similar,
                                        int count, int each, int neighbours) {
  std::vector<std::vector<std::pair<int, ImagePair>>> of_image(count);
  for (const auto& [pair, matches] : similar) {
    of_image[pair.first].emplace_back(-matches, pair);
    of_image[pair.second].emplace_back(-matches, pair);
  }
  std::set<ImagePair> selected;
  for (auto& own : of_image) {
    std::ranges::sort(own);
    for (std::size_t k = 0; k < own.size() && k < static_cast<std::size_t>(each); ++k) {
      selected.insert(own[k].second);
    }
  }
  for (int i = 0; i < count; ++i) {
    for (int k = 1; k <= neighbours && i + k < count; ++k) selected.insert({i, i + k});
  }
  return {selected.begin(), selected.end()};
}

std::vector<ImagePair> PairsBetween(const std::vector<int>& first, const std::vector<int>& second,
                                    std::size_t most) {
  std::set<ImagePair> pairs;
  if (first.empty() || second.empty()) return {};
  const std::size_t each = std::clamp<std::size_t>(most / first.size(), 1, second.size());
  for (const int i : first) {
    for (std::size_t k = 0; k < each; ++k) {
      const int j = second[k * second.size() / each];
      if (i != j) pairs.insert({std::min(i, j), std::max(i, j)});
    }
  }
  return {pairs.begin(), pairs.end()};
}

std::vector<ImagePair> Joined(const std::vector<ImagePair>& a, const std::vector<ImagePair>& b) {
  std::set<ImagePair> pairs(a.begin(), a.end());
  pairs.insert(b.begin(), b.end());
  return {pairs.begin(), pairs.end()};
}

}  // namespace nerf::sfm
