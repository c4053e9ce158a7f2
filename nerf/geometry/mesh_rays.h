#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>

#include "nerf/geometry/mesh.h"

namespace nerf {

// Where a ray meets a mesh.
struct MeshHit {
  float distance = 0;     // along the ray, in lengths of its direction
  std::int32_t face = 0;  // index
  // Weights of the face's vertices; they sum to 1.
  Eigen::Vector3f barycentric = Eigen::Vector3f::Zero();
  bool is_front = true;  // the ray comes from the side on which vertices are counter-clockwise
};

// The normal at a hit, interpolated between those of the vertices; 0: invalid.
Eigen::Vector3f NormalAt(const Mesh& mesh, const MeshHit& hit);
// The vertex of its face that is nearest to a hit.
std::int32_t NearestVertex(const Mesh& mesh, const MeshHit& hit);

// Rays against a mesh, by Embree. All members are const and thread-safe. The result does not depend
// on the number of threads.
class MeshRays {
 public:
  // Copies vertices and faces.
  explicit MeshRays(const Mesh& mesh);
  ~MeshRays();
  MeshRays(const MeshRays&) = delete;
  MeshRays& operator=(const MeshRays&) = delete;

  // The first hit at a distance of at least `nearest`.
  std::optional<MeshHit> FirstHit(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                                  float nearest = 0) const;
  // Whether there is one.
  bool IsBlocked(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                 float nearest = 0) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace nerf
