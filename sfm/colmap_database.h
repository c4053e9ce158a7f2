#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sfm/feature_matching.h"

namespace nerf::sfm {

// Two photographs, by their index in ColmapDatabase::Names: first < second.
struct ImagePair {
  int first = 0, second = 0;

  auto operator<=>(const ImagePair&) const = default;
};

// What was found by matching two photographs.
struct PairMatches {
  ImagePair pair;
  std::vector<FeatureMatch> matches;
  // Those that agree with one geometry; none where too few do.
  std::vector<FeatureMatch> verified;
  Eigen::Matrix3d fundamental = Eigen::Matrix3d::Zero();
};

// Removes a database and the temporary files of SQLite beside it.
void RemoveDatabase(const std::filesystem::path& database);

// A database of COLMAP 3.8 or later, after feature extraction. All methods throw InputError naming
// the file where it is not such a database, or cannot be read or written.
class ColmapDatabase {
 public:
  explicit ColmapDatabase(std::filesystem::path path);
  ~ColmapDatabase();

  // All photographs, sorted.
  const std::vector<std::string>& Names() const { return names_; }

  // The features of a photograph; none where none were extracted.
  Features ReadFeatures(int image) const;

  // The pairs that were matched, with or without result.
  std::set<ImagePair> MatchedPairs() const;
  // The numbers of verified matches of pairs that have some.
  std::vector<std::pair<ImagePair, int>> VerifiedPairs() const;
  std::vector<FeatureMatch> ReadMatches(ImagePair pair) const;
  std::vector<FeatureMatch> ReadVerified(ImagePair pair) const;

  // Writes all, or none where it fails.
  void Write(std::span<const PairMatches> results);
  void RemoveMatches();

 private:
  template <class Work>
  auto Guarded(Work work) const;
  std::vector<FeatureMatch> ReadFrom(const std::string& table, ImagePair pair) const;
  std::int64_t PairId(ImagePair pair) const;
  ImagePair PairOf(std::int64_t id) const;

  struct Connection;  // to SQLite
  std::filesystem::path path_;
  std::unique_ptr<Connection> connection_;
  std::vector<std::string> names_;
  std::vector<std::int64_t> ids_;  // of the photographs in `names_`
};

}  // namespace nerf::sfm
