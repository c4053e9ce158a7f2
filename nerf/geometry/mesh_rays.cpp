#include "nerf/geometry/mesh_rays.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <limits>
#include <new>

namespace nerf {
namespace {

RTCRay RayFrom(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest) {
  RTCRay ray{};
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tnear = nearest;
  ray.tfar = std::numeric_limits<float>::infinity();
  ray.mask = ~0u;
  return ray;
}

}  // namespace

Eigen::Vector3f NormalAt(const Mesh& mesh, const MeshHit& hit) {
  const auto& face = mesh.faces[static_cast<std::size_t>(hit.face)];
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  for (int k = 0; k < 3; ++k) normal += hit.barycentric[k] * mesh.normals[face[k]];
  return normal.stableNormalized();
}

std::int32_t NearestVertex(const Mesh& mesh, const MeshHit& hit) {
  int nearest = 0;
  hit.barycentric.maxCoeff(&nearest);
  return mesh.faces[static_cast<std::size_t>(hit.face)][nearest];
}

struct MeshRays::Scene {
  RTCDevice device;
  RTCScene scene;

  // One thread builds it, so that it is the same each time; Embree's own threads are not used.
  Scene() : device(rtcNewDevice("threads=1,user_threads=1")), scene(rtcNewScene(device)) {
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);  // rays do not slip between triangles
  }
  ~Scene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

MeshRays::MeshRays(const Mesh& mesh) : scene_(std::make_unique<Scene>()) {
  const RTCGeometry geometry = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* const vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              3 * sizeof(float), mesh.vertices.size()));
  auto* const faces = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh.faces.size()));
  if ((vertices == nullptr && !mesh.vertices.empty()) ||
      (faces == nullptr && !mesh.faces.empty())) {
    rtcReleaseGeometry(geometry);
    throw std::bad_alloc();
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    std::copy_n(mesh.vertices[i].data(), 3, vertices + 3 * i);
  }
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    for (int k = 0; k < 3; ++k) faces[3 * i + k] = static_cast<std::uint32_t>(mesh.faces[i][k]);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_->scene);
}

MeshRays::~MeshRays() = default;

std::optional<MeshHit> MeshRays::FirstHit(const Eigen::Vector3f& origin,
                                          const Eigen::Vector3f& direction, float nearest) const {
  RTCRayHit query{};
  query.ray = RayFrom(origin, direction, nearest);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  MeshHit hit;
  hit.distance = query.ray.tfar;
  hit.face = static_cast<std::int32_t>(query.hit.primID);
  hit.barycentric = {1 - query.hit.u - query.hit.v, query.hit.u, query.hit.v};
  const Eigen::Vector3f normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
  hit.is_front = normal.dot(direction) < 0;
  return hit;
}

bool MeshRays::IsBlocked(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                         float nearest) const {
  RTCRay ray = RayFrom(origin, direction, nearest);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene_->scene, &context, &ray);
  return ray.tfar < 0;  // Embree's mark of a hit
}

}  // namespace nerf
