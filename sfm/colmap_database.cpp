#include "sfm/colmap_database.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/kernels/descriptor_matching.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;

// COLMAP's pair_id is image_id1 * kMostImages + image_id2, with image_id1 < image_id2.
constexpr std::int64_t kMostImages = 2147483647;
constexpr int kBusyMilliseconds = 2000;
constexpr int kUncalibrated = 3;  // COLMAP's number for a geometry that is a fundamental matrix
constexpr int kDegenerate = 1;    // and for none

// Features and matches take long to compute, so only a damaged database is to be removed.
[[noreturn]] void ThrowAbout(const fs::path& path, const SQLite::Exception& error) {
  switch (error.getErrorCode()) {
    case SQLITE_FULL:
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
      throw InputError("{}: {}; free some disk space, check permissions, and run again",
                       path.string(), error.what());
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw InputError("{}: {}; close the program that uses it and run again", path.string(),
                       error.what());
    default:
      throw InputError("{}: {}; remove it and run again", path.string(), error.what());
  }
}

// A table of a blob, by rows.
struct Table {
  std::size_t rows = 0, columns = 0;
  std::string bytes;
};

Table ReadTable(SQLite::Database& database, const char* name, std::int64_t image,
                std::size_t bytes_a_number) {
  SQLite::Statement read(
      database, std::string("SELECT rows, cols, data FROM ") + name + " WHERE image_id = ?");
  read.bind(1, image);
  if (!read.executeStep()) return {};
  Table table{read.getColumn(0).getUInt(), read.getColumn(1).getUInt(), {}};
  const SQLite::Column blob = read.getColumn(2);
  const auto bytes = static_cast<std::size_t>(blob.getBytes());
  if (table.rows > bytes || bytes != table.rows * table.columns * bytes_a_number) {
    throw SQLite::Exception(std::string(name) + " are truncated");
  }
  if (bytes > 0) table.bytes.assign(static_cast<const char*>(blob.getBlob()), bytes);
  return table;
}

// Columns are x, y and either scale and angle or a 2 x 2 matrix.
float ScaleOf(const float* keypoint, std::size_t columns) {
  if (columns < 6) return columns >= 4 ? keypoint[2] : 1.0f;
  return std::sqrt(std::fabs(keypoint[2] * keypoint[5] - keypoint[3] * keypoint[4]));
}

// Matches as COLMAP stores them: the photograph of the smaller id first.
std::vector<std::uint32_t> Stored(const std::vector<FeatureMatch>& matches, bool swapped) {
  std::vector<std::uint32_t> numbers;
  for (const FeatureMatch& match : matches) {
    numbers.push_back(swapped ? match.second : match.first);
    numbers.push_back(swapped ? match.first : match.second);
  }
  return numbers;
}

void BindTable(SQLite::Statement& statement, const std::vector<std::uint32_t>& numbers) {
  statement.bind(2, static_cast<std::int64_t>(numbers.size() / 2));
  statement.bind(3, 2);
  statement.bind(4, numbers.data(), static_cast<int>(numbers.size() * sizeof(numbers[0])));
}

}  // namespace

struct ColmapDatabase::Connection {
  explicit Connection(const fs::path& path)
      : database(path.string(), SQLite::OPEN_READWRITE, kBusyMilliseconds) {}
  SQLite::Database database;
};

template <class Work>
auto ColmapDatabase::Guarded(Work work) const {
  try {
    return work(connection_->database);
  } catch (const SQLite::Exception& error) {
    ThrowAbout(path_, error);
  }
}

ColmapDatabase::ColmapDatabase(fs::path path) : path_(std::move(path)) {
  try {
    connection_ = std::make_unique<Connection>(path_);
    SQLite::Statement all(connection_->database, "SELECT image_id, name FROM images ORDER BY name");
    while (all.executeStep()) {
      ids_.push_back(all.getColumn(0).getInt64());
      names_.push_back(all.getColumn(1).getString());
    }
  } catch (const SQLite::Exception& error) {
    ThrowAbout(path_, error);
  }
}

ColmapDatabase::~ColmapDatabase() = default;

Features ColmapDatabase::ReadFeatures(int image) const {
  return Guarded([&](SQLite::Database& database) {
    const Table keypoints = ReadTable(database, "keypoints", ids_[image], sizeof(float));
    const Table descriptors = ReadTable(database, "descriptors", ids_[image], 1);
    if (keypoints.rows != descriptors.rows || (keypoints.rows > 0 && keypoints.columns < 2)) {
      throw SQLite::Exception("keypoints and descriptors differ in number");
    }
    if (descriptors.rows > 0 && descriptors.columns != kernels::kDescriptorSize) {
      throw SQLite::Exception("has features other than SIFT");
    }
    Features features;
    std::vector<float> numbers(keypoints.rows * keypoints.columns);
    if (!numbers.empty()) {
      std::memcpy(numbers.data(), keypoints.bytes.data(), keypoints.bytes.size());
    }
    for (std::size_t row = 0; row < keypoints.rows; ++row) {
      const float* const keypoint = &numbers[row * keypoints.columns];
      features.positions.emplace_back(keypoint[0], keypoint[1]);
      features.scales.push_back(ScaleOf(keypoint, keypoints.columns));
    }
    features.descriptors.assign(descriptors.bytes.begin(), descriptors.bytes.end());
    return features;
  });
}

std::int64_t ColmapDatabase::PairId(ImagePair pair) const {
  const auto [lower, upper] = std::minmax(ids_[pair.first], ids_[pair.second]);
  return lower * kMostImages + upper;
}

// {-1, -1} for photographs that are not there.
ImagePair ColmapDatabase::PairOf(std::int64_t id) const {
  const auto index = [&](std::int64_t image) {
    const auto found = std::ranges::find(ids_, image);
    return found == ids_.end() ? -1 : static_cast<int>(found - ids_.begin());
  };
  const int a = index(id / kMostImages), b = index(id % kMostImages);
  if (a < 0 || b < 0) return {-1, -1};
  return {std::min(a, b), std::max(a, b)};
}

std::set<ImagePair> ColmapDatabase::MatchedPairs() const {
  return Guarded([&](SQLite::Database& database) {
    std::set<ImagePair> pairs;
    SQLite::Statement all(database, "SELECT pair_id FROM two_view_geometries");
    while (all.executeStep()) pairs.insert(PairOf(all.getColumn(0).getInt64()));
    pairs.erase({-1, -1});
    return pairs;
  });
}

std::vector<std::pair<ImagePair, int>> ColmapDatabase::VerifiedPairs() const {
  return Guarded([&](SQLite::Database& database) {
    std::vector<std::pair<ImagePair, int>> pairs;
    SQLite::Statement all(database, "SELECT pair_id, rows FROM two_view_geometries WHERE rows > 0");
    while (all.executeStep()) {
      const ImagePair pair = PairOf(all.getColumn(0).getInt64());
      if (pair.first >= 0) pairs.emplace_back(pair, all.getColumn(1).getInt());
    }
    std::ranges::sort(pairs);
    return pairs;
  });
}

std::vector<FeatureMatch> ColmapDatabase::ReadMatches(ImagePair pair) const {
  return ReadFrom("matches", pair);
}

std::vector<FeatureMatch> ColmapDatabase::ReadVerified(ImagePair pair) const {
  return ReadFrom("two_view_geometries", pair);
}

std::vector<FeatureMatch> ColmapDatabase::ReadFrom(const std::string& table, ImagePair pair) const {
  return Guarded([&](SQLite::Database& database) {
    std::vector<FeatureMatch> matches;
    SQLite::Statement read(database, "SELECT rows, data FROM " + table + " WHERE pair_id = ?");
    read.bind(1, PairId(pair));
    if (!read.executeStep()) return matches;
    const SQLite::Column blob = read.getColumn(1);
    const auto bytes = static_cast<std::size_t>(blob.getBytes());
    if (read.getColumn(0).getInt64() * static_cast<std::int64_t>(sizeof(FeatureMatch)) !=
        static_cast<std::int64_t>(bytes)) {
      throw SQLite::Exception("matches are truncated");
    }
    matches.resize(bytes / sizeof(FeatureMatch));
    if (!matches.empty()) std::memcpy(matches.data(), blob.getBlob(), blob.getBytes());
    if (ids_[pair.first] > ids_[pair.second]) {
      for (FeatureMatch& match : matches) std::swap(match.first, match.second);
    }
    const auto rows = [&](int image) {
      SQLite::Statement count(database, "SELECT rows FROM keypoints WHERE image_id = ?");
      count.bind(1, ids_[image]);
      return count.executeStep() ? count.getColumn(0).getUInt() : 0;
    };
    const std::uint32_t first = rows(pair.first), second = rows(pair.second);
    for (const FeatureMatch& match : matches) {
      if (match.first >= first || match.second >= second) {
        throw SQLite::Exception("has matches of features that it does not have");
      }
    }
    return matches;
  });
}

void ColmapDatabase::Write(std::span<const PairMatches> results) {
  Guarded([&](SQLite::Database& database) {
    SQLite::Transaction transaction(database);
    SQLite::Statement matches(
        database, "INSERT OR REPLACE INTO matches (pair_id, rows, cols, data) VALUES (?, ?, ?, ?)");
    SQLite::Statement geometry(database,
                               "INSERT OR REPLACE INTO two_view_geometries (pair_id, rows, cols, "
                               "data, config, F) VALUES (?, ?, ?, ?, ?, ?)");
    for (const PairMatches& result : results) {
      const bool swapped = ids_[result.pair.first] > ids_[result.pair.second];
      const std::int64_t id = PairId(result.pair);
      const std::vector<std::uint32_t> all = Stored(result.matches, swapped);
      const std::vector<std::uint32_t> verified = Stored(result.verified, swapped);
      // COLMAP stores matrices by rows.
      const Eigen::Matrix3d by_columns =
          swapped ? result.fundamental : Eigen::Matrix3d(result.fundamental.transpose());
      matches.bind(1, id);
      BindTable(matches, all);
      matches.exec();
      matches.reset();
      geometry.bind(1, id);
      BindTable(geometry, verified);
      geometry.bind(5, verified.empty() ? kDegenerate : kUncalibrated);
      geometry.bind(6, by_columns.data(), static_cast<int>(9 * sizeof(double)));
      geometry.exec();
      geometry.reset();
    }
    transaction.commit();
  });
}

void ColmapDatabase::RemoveMatches() {
  Guarded([](SQLite::Database& database) {
    database.exec("DELETE FROM matches");
    database.exec("DELETE FROM two_view_geometries");
  });
}

void RemoveDatabase(const fs::path& database) {
  for (const char* suffix : {"", "-shm", "-wal", "-journal"}) RemoveAll(database.string() + suffix);
}

}  // namespace nerf::sfm
