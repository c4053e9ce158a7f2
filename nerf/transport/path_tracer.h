#pragma once

#include <cstdint>
#include <map>

#include "nerf/base/random.h"
#include "nerf/transport/subsurface.h"
#include "nerf/transport/surface_scene.h"

namespace nerf {

// The terms of the rendering equation that are computed; disabled terms cost no rays.
//   L_o = L_e + integral of f_r L_i cos(theta) d omega      (Kajiya 1986)
struct TransportTerms {
  bool emission = true;  // emitters and environment as the camera sees them
  bool direct = true;    // reflected light from lights, environment and emitters
  bool shadows = true;   // off: lights and environment (but not emitters) pass through surfaces
  int bounces = 1;       // of indirect light, 0 to 100; needs `direct`

  // Throws InputError, naming the flag, if a value is out of range.
  void Check() const;
};

// A stream of uniform numbers in [0,1) that depends on its key alone.
class UniformStream {
 public:
  UniformStream(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample)
      : key_(RandomBits(seed, pixel, sample)) {}
  double Next() { return static_cast<double>(Mix64(key_ + count_++) >> 11) * 0x1p-53; }
  Eigen::Array2d Next2() { return {Next(), Next()}; }
  Eigen::Array3d Next3() { return {Next(), Next(), Next()}; }

 private:
  std::uint64_t key_;
  std::uint64_t count_ = 0;
};

// Estimates radiance by tracing paths from the camera (Kajiya 1986). At each surface all lights are
// evaluated; the environment is sampled both by its luminance and by the BRDF, combined with the
// power heuristic (Veach 1997); emitters are found by BRDF samples alone.
// Translucent spheres are lit once, in the constructor, by lights and environment. Emitters and
// indirect light do not light them, so that with bounces they are slightly too dark next to bright
// surfaces; the light that they emit reaches other surfaces.
class PathTracer {
 public:
  // Keeps a reference to the scene. Throws InputError if the terms are out of range.
  PathTracer(const SurfaceScene& scene, const TransportTerms& terms, std::uint64_t seed = 0);

  // Traces one path. The expected value over `random` is the radiance at the origin of the ray.
  //   rays  is increased by the number of rays traced
  Color Radiance(Ray ray, UniformStream& random, std::int64_t& rays) const;

 private:
  struct Vertex;
  Color DirectLight(const Vertex& vertex, UniformStream& random, std::int64_t& rays) const;
  bool IsUnoccluded(const Vertex& vertex, const Eigen::Vector3d& direction, double distance,
                    std::int64_t& rays) const;

  const SurfaceScene& scene_;
  TransportTerms terms_;
  bool has_emitters_ = false;
  std::map<const Surface*, SubsurfaceSphere::Exitance> exitance_;
};

}  // namespace nerf
