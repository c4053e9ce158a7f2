#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <filesystem>
#include <string>
#include <vector>

namespace nerf::test {

// An image of a COLMAP database, with keypoints of the given scales and descriptors that contain
// the index of their keypoint.
struct DatabaseImage {
  std::string name;
  std::vector<float> scales;
};

// Two images, by index, and the number of inlier matches between them.
struct DatabasePair {
  int first = 0, second = 0;
  int inliers = 0;
};

// Writes a database with the tables and columns of COLMAP 3.8 that the project reads.
inline void WriteColmapDatabase(const std::filesystem::path& path,
                                const std::vector<DatabaseImage>& images,
                                const std::vector<DatabasePair>& pairs = {}) {
  std::filesystem::remove(path);
  SQLite::Database database(path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  database.exec("CREATE TABLE images (image_id INTEGER PRIMARY KEY, name TEXT)");
  database.exec("CREATE TABLE matches (pair_id INTEGER PRIMARY KEY, rows INTEGER)");
  database.exec("CREATE TABLE two_view_geometries (pair_id INTEGER PRIMARY KEY, rows INTEGER)");
  for (const char* table : {"keypoints", "descriptors"}) {
    database.exec("CREATE TABLE " + std::string(table) +
                  " (image_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, data BLOB)");
  }
  const auto insert = [&](const char* table, int image, std::size_t rows, int columns,
                          const void* data, std::size_t bytes) {
    SQLite::Statement row(database, "INSERT INTO " + std::string(table) + " VALUES (?, ?, ?, ?)");
    row.bind(1, image);
    row.bind(2, static_cast<int>(rows));
    row.bind(3, columns);
    row.bind(4, data, static_cast<int>(bytes));
    row.exec();
  };
  for (std::size_t i = 0; i < images.size(); ++i) {
    const int id = static_cast<int>(i) + 1;
    SQLite::Statement row(database, "INSERT INTO images VALUES (?, ?)");
    row.bind(1, id);
    row.bind(2, images[i].name);
    row.exec();
    std::vector<float> keypoints;
    std::string descriptors;
    for (std::size_t k = 0; k < images[i].scales.size(); ++k) {
      const float scale = images[i].scales[k];
      keypoints.insert(keypoints.end(), {static_cast<float>(k), 0, 0, -scale, scale, 0});
      descriptors += std::string(128, static_cast<char>(k));
    }
    insert("keypoints", id, images[i].scales.size(), 6, keypoints.data(),
           keypoints.size() * sizeof(float));
    insert("descriptors", id, images[i].scales.size(), 128, descriptors.data(), descriptors.size());
  }
  for (const DatabasePair& pair : pairs) {
    SQLite::Statement row(database, "INSERT INTO two_view_geometries VALUES (?, ?)");
    row.bind(1, (pair.first + 1) * std::int64_t{2147483647} + pair.second + 1);
    row.bind(2, pair.inliers);
    row.exec();
  }
}

}  // namespace nerf::test
