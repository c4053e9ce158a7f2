#pragma once

#include <utility>
#include <vector>

#include "sfm/colmap_database.h"

namespace nerf::sfm {

// Which pairs of photographs to match, of `count` that are sorted by name. All are sorted and
// without duplicates.

std::vector<ImagePair> AllPairs(int count);

// Each with its next `overlap` photographs, and with those at distances of powers of two up to
// 2^(overlap - 1).
std::vector<ImagePair> SequentialPairs(int count, int overlap);

// For each photograph the `each` pairs with most matches, and those with the `neighbours` next
// photographs by name, since photographs are mostly named in the order in which they were taken.
//   similar  pairs with their number of matches
std::vector<ImagePair> MostSimilarPairs(const std::vector<std::pair<ImagePair, int>>& similar,
                                        int count, int each, int neighbours);

// Each of `first` with each of `second`, or, where these are more than `most` pairs, with as many
// of them, at equal distances by name.
std::vector<ImagePair> PairsBetween(const std::vector<int>& first, const std::vector<int>& second,
                                    std::size_t most);

// The pairs of both.
std::vector<ImagePair> Joined(const std::vector<ImagePair>& a, const std::vector<ImagePair>& b);

}  // namespace nerf::sfm
