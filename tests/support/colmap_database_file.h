#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <string>
#include <vector>

#include "nerf/kernels/descriptor_matching.h"
#include "sfm/feature_matching.h"

namespace nerf::test {

struct DatabaseImage {
  std::string name;
  sfm::Features features = {};
};

// Writes a database as COLMAP 3.8 has it after feature extraction. The ids of the images fall, so
// that the order by name and that by id differ if the names are sorted.
inline void WriteColmapDatabase(const std::filesystem::path& path,
                                const std::vector<DatabaseImage>& images) {
  std::filesystem::remove(path);
  SQLite::Database database(path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  SQLite::Transaction transaction(database);
  database.exec(
      "CREATE TABLE images (image_id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, name TEXT NOT "
      "NULL UNIQUE, camera_id INTEGER NOT NULL)");
  database.exec(
      "CREATE TABLE matches (pair_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER NOT NULL, cols "
      "INTEGER NOT NULL, data BLOB)");
  database.exec(
      "CREATE TABLE two_view_geometries (pair_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER NOT "
      "NULL, cols INTEGER NOT NULL, data BLOB, config INTEGER NOT NULL, F BLOB, E BLOB, H BLOB, "
      "qvec BLOB, tvec BLOB)");
  for (const char* table : {"keypoints", "descriptors"}) {
    database.exec(fmt::format(
        "CREATE TABLE {} (image_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, data BLOB)",
        table));
  }
  const auto insert = [&](const char* table, int image, int rows, int columns, const void* data,
                          std::size_t bytes) {
    SQLite::Statement row(database, fmt::format("INSERT INTO {} VALUES (?, ?, ?, ?)", table));
    row.bind(1, image);
    row.bind(2, rows);
    row.bind(3, columns);
    row.bind(4, data, static_cast<int>(bytes));
    row.exec();
  };
  for (std::size_t i = 0; i < images.size(); ++i) {
    const int id = static_cast<int>(images.size() - i);
    const sfm::Features& features = images[i].features;
    SQLite::Statement row(database, "INSERT INTO images VALUES (?, ?, 1)");
    row.bind(1, id);
    row.bind(2, images[i].name);
    row.exec();
    std::vector<float> keypoints;
    for (int k = 0; k < features.Count(); ++k) {
      const float scale = features.scales[k];
      keypoints.insert(keypoints.end(),
                       {features.positions[k].x(), features.positions[k].y(), 0, -scale, scale, 0});
    }
    insert("keypoints", id, features.Count(), 6, keypoints.data(),
           keypoints.size() * sizeof(float));
    insert("descriptors", id, features.Count(), kernels::kDescriptorSize,
           features.descriptors.data(), features.descriptors.size());
  }
  transaction.commit();
}

}  // namespace nerf::test
