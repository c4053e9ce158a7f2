#include "nerf/geometry/level_set_mesh.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <mutex>

#include "nerf/base/parallel.h"

namespace nerf {
namespace {

// The values as OpenVDB has them, at integer positions.
openvdb::FloatGrid::Ptr ToOpenVdb(const ScalarGrid& grid, double level) {
  static std::once_flag initialized;
  std::call_once(initialized, [] { openvdb::initialize(); });
  const openvdb::CoordBBox box({0, 0, 0},
                               {grid.size.x() - 1, grid.size.y() - 1, grid.size.z() - 1});
  // Not changed by copyFromDense, whose argument is const.
  const openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(
      box, const_cast<float*>(grid.values.data()));
  // Outside the grid nothing is inside the surface.
  auto volume = openvdb::FloatGrid::create(static_cast<float>(level + 1e3 * grid.cell));
  openvdb::tools::copyFromDense(dense, *volume, 0.0f);
  return volume;
}

}  // namespace

Mesh LevelSetMesh(const ScalarGrid& grid, double level) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*ToOpenVdb(grid, level), points, triangles, quads, level);

  Mesh mesh;
  mesh.vertices.resize(points.size());
  mesh.normals.resize(points.size());
  ParallelFor(static_cast<std::int64_t>(points.size()), 256,
              [&](std::int64_t begin, std::int64_t end) {
                for (std::int64_t i = begin; i < end; ++i) {
                  const Eigen::Vector3d at =
                      grid.origin +
                      grid.cell * Eigen::Vector3d(points[i].x(), points[i].y(), points[i].z());
                  mesh.vertices[i] = at.cast<float>();
                  mesh.normals[i] = grid.Gradient(at).stableNormalized().cast<float>();
                }
              });
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.faces.push_back(
        {static_cast<std::int32_t>(a), static_cast<std::int32_t>(b), static_cast<std::int32_t>(c)});
  };
  for (const openvdb::Vec3I& t : triangles) add(t[0], t[1], t[2]);
  for (const openvdb::Vec4I& q : quads) {
    add(q[0], q[1], q[2]);
    add(q[0], q[2], q[3]);
  }
  return mesh;
}

}  // namespace nerf
