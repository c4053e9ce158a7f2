#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace nerf::sfm {

// A pair of photographs with verified matches.
struct MatchedPair {
  std::string first, second;  // names in the database
  int inliers = 0;            // matches that agree with one relative pose
};

// Removes a database and the temporary files of SQLite beside it.
void RemoveDatabase(const std::filesystem::path& database);

// Copies a COLMAP database as it is after feature extraction, with only the `features` of largest
// scale of each photograph: these are matched most often (Wu 2013, "Towards Linear-Time Incremental
// Structure from Motion", section 3), and few are matched quickly. Replaces `coarse`.
// All functions on files throw InputError naming the file where it is not such a database, or
// cannot be read or written.
void CopyLargestFeatures(const std::filesystem::path& database, const std::filesystem::path& coarse,
                         int features);

// The names of all photographs.
std::vector<std::string> ReadImageNames(const std::filesystem::path& database);

// The pairs with verified matches, sorted by name.
std::vector<MatchedPair> ReadMatchedPairs(const std::filesystem::path& database);

// Selects the pairs to match with all features: for each photograph the `each` pairs with most
// inliers, and those with the `neighbours` next photographs by name, since photographs are mostly
// named in the order in which they were taken.
//   names    all photographs
//   returns  sorted, without duplicates
std::vector<std::pair<std::string, std::string>> SelectPairs(const std::vector<MatchedPair>& pairs,
                                                             std::vector<std::string> names,
                                                             int each, int neighbours);

}  // namespace nerf::sfm
