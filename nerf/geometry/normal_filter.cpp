#include "nerf/geometry/normal_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "nerf/base/parallel.h"

namespace nerf {
namespace {

// The neighbours of vertex v are rows first[v] to first[v + 1].
struct Neighbours {
  std::vector<std::size_t> first;
  std::vector<std::int32_t> rows;
};

Neighbours NeighboursOf(const Mesh& mesh) {
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  edges.reserve(6 * mesh.faces.size());
  for (const auto& face : mesh.faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      edges.emplace_back(face[k], face[(k + 1) % 3]);
      edges.emplace_back(face[(k + 1) % 3], face[k]);
    }
  }
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  Neighbours neighbours;
  neighbours.first.assign(mesh.vertices.size() + 1, 0);
  for (const auto& [from, to] : edges) {
    ++neighbours.first[static_cast<std::size_t>(from) + 1];
    neighbours.rows.push_back(to);
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    neighbours.first[v + 1] += neighbours.first[v];
  }
  return neighbours;
}

}  // namespace

void FilterNormals(Mesh& mesh, const NormalFilterOptions& options) {
  const Neighbours neighbours = NeighboursOf(mesh);
  // |a - b|^2 of unit vectors at an angle t is 4 sin^2(t / 2).
  const double sine = std::sin(options.angle * std::numbers::pi / 360);
  const auto sharpness = static_cast<float>(1 / std::max(1e-6, 4 * sine * sine));
  std::vector<Eigen::Vector3f> next = mesh.normals;
  for (int i = 0; i < options.iterations; ++i) {
    ParallelForEach(static_cast<std::int64_t>(next.size()), [&](std::int64_t index) {
      const auto v = static_cast<std::size_t>(index);
      const Eigen::Vector3f own = mesh.normals[v];
      if (own.isZero()) return;
      Eigen::Vector3f sum = own;
      for (std::size_t k = neighbours.first[v]; k < neighbours.first[v + 1]; ++k) {
        const Eigen::Vector3f& other = mesh.normals[static_cast<std::size_t>(neighbours.rows[k])];
        if (other.isZero()) continue;
        sum += std::exp(-sharpness * (own - other).squaredNorm()) * other;
      }
      next[v] = sum.stableNormalized();
    });
    mesh.normals = next;
  }
}

}  // namespace nerf
