#include "sfm/colmap_database.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <set>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;

// COLMAP's pair_id is image_id1 * kMostImages + image_id2, with image_id1 < image_id2.
constexpr std::int64_t kMostImages = 2147483647;

// Calls work(database) and turns errors of SQLite into an InputError that names the file.
template <class Work>
auto WithDatabase(const fs::path& path, int flags, Work work) {
  try {
    SQLite::Database database(path.string(), flags);
    return work(database);
  } catch (const SQLite::Exception& error) {
    // Features and matches take hours to compute, so only a damaged database is to be removed.
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
}

// The square of a keypoint's scale. Columns are x, y and either scale and angle or a 2 x 2 matrix.
float SquaredScale(const float* keypoint, int columns) {
  if (columns < 6) return columns >= 4 ? keypoint[2] * keypoint[2] : 1.0f;
  return std::fabs(keypoint[2] * keypoint[5] - keypoint[3] * keypoint[4]);
}

// The rows `kept` of a blob.
std::string RowsOf(const SQLite::Column& blob, std::size_t bytes_a_row,
                   const std::vector<std::size_t>& kept) {
  const auto* const bytes = static_cast<const char*>(blob.getBlob());
  std::string rows;
  for (const std::size_t row : kept) rows.append(bytes + row * bytes_a_row, bytes_a_row);
  return rows;
}

std::vector<std::size_t> LargestOf(const SQLite::Column& blob, std::size_t rows, int columns,
                                   std::size_t wanted) {
  std::vector<float> numbers(rows * columns);
  if (static_cast<std::size_t>(blob.getBytes()) != numbers.size() * sizeof(float)) {
    throw SQLite::Exception("keypoints are truncated");
  }
  if (rows > 0) std::memcpy(numbers.data(), blob.getBlob(), numbers.size() * sizeof(float));
  std::vector<std::size_t> order(rows);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t row) {
    return SquaredScale(&numbers[row * columns], columns);
  });
  order.resize(std::min(order.size(), wanted));
  std::ranges::sort(order);
  return order;
}

void Replace(SQLite::Database& database, const std::string& table, std::int64_t image,
             std::size_t rows, const std::string& data) {
  SQLite::Statement update(database,
                           "UPDATE " + table + " SET rows = ?, data = ? WHERE image_id = ?");
  update.bind(1, static_cast<std::int64_t>(rows));
  update.bind(2, data.data(), static_cast<int>(data.size()));
  update.bind(3, image);
  update.exec();
}

}  // namespace

void RemoveDatabase(const fs::path& database) {
  for (const char* suffix : {"", "-shm", "-wal", "-journal"}) RemoveAll(database.string() + suffix);
}

void CopyLargestFeatures(const fs::path& database, const fs::path& coarse, int features) {
  RemoveDatabase(coarse);
  WithDatabase(database, SQLite::OPEN_READONLY, [&](SQLite::Database& full) {
    SQLite::Statement copy(full, "VACUUM INTO ?");
    copy.bind(1, coarse.string());
    copy.exec();
  });
  WithDatabase(coarse, SQLite::OPEN_READWRITE, [&](SQLite::Database& copy) {
    SQLite::Transaction transaction(copy);
    copy.exec("DELETE FROM matches");
    copy.exec("DELETE FROM two_view_geometries");
    std::vector<std::int64_t> images;
    for (SQLite::Statement all(copy, "SELECT image_id FROM images"); all.executeStep();) {
      images.push_back(all.getColumn(0).getInt64());
    }
    for (const std::int64_t image : images) {
      SQLite::Statement keypoints(copy,
                                  "SELECT rows, cols, data FROM keypoints WHERE image_id = ?");
      SQLite::Statement descriptors(copy,
                                    "SELECT rows, cols, data FROM descriptors WHERE image_id = ?");
      keypoints.bind(1, image);
      descriptors.bind(1, image);
      if (!keypoints.executeStep() || !descriptors.executeStep()) continue;
      const std::size_t rows = keypoints.getColumn(0).getUInt();
      const int columns = keypoints.getColumn(1).getInt(),
                width = descriptors.getColumn(1).getInt();
      if (descriptors.getColumn(0).getUInt() != rows || columns < 1 || width < 1 ||
          static_cast<std::size_t>(descriptors.getColumn(2).getBytes()) != rows * width) {
        throw SQLite::Exception("keypoints and descriptors differ in number");
      }
      const auto kept = LargestOf(keypoints.getColumn(2), rows, columns, features);
      const std::string kept_keypoints =
          RowsOf(keypoints.getColumn(2), columns * sizeof(float), kept);
      const std::string kept_descriptors = RowsOf(descriptors.getColumn(2), width, kept);
      keypoints.reset();
      descriptors.reset();
      Replace(copy, "keypoints", image, kept.size(), kept_keypoints);
      Replace(copy, "descriptors", image, kept.size(), kept_descriptors);
    }
    transaction.commit();
  });
}

std::vector<std::string> ReadImageNames(const fs::path& database) {
  return WithDatabase(database, SQLite::OPEN_READONLY, [](SQLite::Database& read) {
    std::vector<std::string> names;
    for (SQLite::Statement all(read, "SELECT name FROM images ORDER BY name"); all.executeStep();) {
      names.push_back(all.getColumn(0).getString());
    }
    return names;
  });
}

std::vector<MatchedPair> ReadMatchedPairs(const fs::path& database) {
  return WithDatabase(database, SQLite::OPEN_READONLY, [](SQLite::Database& read) {
    std::map<std::int64_t, std::string> names;
    for (SQLite::Statement all(read, "SELECT image_id, name FROM images"); all.executeStep();) {
      names[all.getColumn(0).getInt64()] = all.getColumn(1).getString();
    }
    std::vector<MatchedPair> pairs;
    SQLite::Statement all(read, "SELECT pair_id, rows FROM two_view_geometries WHERE rows > 0");
    while (all.executeStep()) {
      const std::int64_t pair = all.getColumn(0).getInt64();
      const auto first = names.find(pair / kMostImages), second = names.find(pair % kMostImages);
      if (first == names.end() || second == names.end()) continue;
      pairs.push_back({first->second, second->second, all.getColumn(1).getInt()});
      if (pairs.back().first > pairs.back().second) {
        std::swap(pairs.back().first, pairs.back().second);
      }
    }
    std::ranges::sort(pairs, {}, [](const MatchedPair& p) { return std::tie(p.first, p.second); });
    return pairs;
  });
}

std::vector<std::pair<std::string, std::string>> SelectPairs(const std::vector<MatchedPair>& pairs,
                                                             std::vector<std::string> names,
                                                             int each, int neighbours) {
  std::map<std::string, std::vector<const MatchedPair*>> of_photo;
  for (const MatchedPair& pair : pairs) {
    of_photo[pair.first].push_back(&pair);
    of_photo[pair.second].push_back(&pair);
  }
  std::set<std::pair<std::string, std::string>> selected;
  for (auto& [name, own] : of_photo) {
    std::ranges::stable_sort(own, std::greater<>(), &MatchedPair::inliers);
    for (std::size_t k = 0; k < own.size() && k < static_cast<std::size_t>(each); ++k) {
      selected.emplace(own[k]->first, own[k]->second);
    }
  }
  std::ranges::sort(names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t k = 1; k <= static_cast<std::size_t>(neighbours) && i + k < names.size();
         ++k) {
      selected.emplace(names[i], names[i + k]);
    }
  }
  return {selected.begin(), selected.end()};
}

}  // namespace nerf::sfm
