#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace nerf::sfm {

// Two photographs that COLMAP found to show the same thing.
struct MatchedPair {
  std::string first, second;  // names in the database
  int inliers = 0;            // matches that agree with one relative pose
};

// Removes a database and what SQLite keeps beside it.
void RemoveDatabase(const std::filesystem::path& database);

// Copies a database of COLMAP's as it is after feature extraction, with only the `features` largest
// of each photograph: they are the ones most often found again (Wu 2013, "Towards Linear-Time
// Incremental Structure from Motion", section 3), and comparing few is quick. Replaces `coarse`.
// All functions on files throw InputError naming the file where it is not such a database, or
// cannot be read or written.
void CopyLargestFeatures(const std::filesystem::path& database, const std::filesystem::path& coarse,
                         int features);

// The names of all photographs.
std::vector<std::string> ReadImageNames(const std::filesystem::path& database);

// The pairs with verified matches, in the order of their names.
std::vector<MatchedPair> ReadMatchedPairs(const std::filesystem::path& database);

// The pairs that are worth comparing in full: of each photograph those `each` with most inliers,
// and its `neighbours` next by name, for photographs are mostly named in the order in which they
// were taken. Sorted, none twice.
//   names  all photographs
std::vector<std::pair<std::string, std::string>> SelectPairs(const std::vector<MatchedPair>& pairs,
                                                             std::vector<std::string> names,
                                                             int each, int neighbours);

}  // namespace nerf::sfm
