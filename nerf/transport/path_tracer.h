#pragma once

#include <cstdint>
#include <map>

#include "nerf/base/random.h"
#include "nerf/transport/subsurface.h"
#include "nerf/transport/surface_scene.h"

namespace nerf {

// Which terms of the rendering equation are computed; one that is off costs no ray.
//   L_o = L_e + integral of f_r L_i cos(theta) d omega      (Kajiya 1986)
struct TransportTerms {
  bool emission = true;  // what a camera sees shine: emitters and the environment behind all
  bool direct = true;    // the light of lights, environment and emitters, reflected once
  bool shadows = true;   // off: lights and environment shine through surfaces (emitters do not)
  int bounces = 1;       // further surfaces that light may visit on its way, 0 to 100; needs direct

  // Throws InputError, naming the flag, where a value is out of range.
  void Check() const;
};

// Uniform numbers in [0,1) without hidden state: functions of a key (a pixel's sample).
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

// Estimates radiance along rays by paths from the camera. Lights and the environment are drawn at
// each surface, the environment also by the BRDF's own directions, weighted by the power heuristic
// (Veach 1997); emitters are found by those alone.
// A translucent body is lit once, when the tracer is made, by the lights and the environment alone:
// light that other surfaces bounce to it, or that emitters send, does not enter it, so with bounces
// it is a little too dark beside bright neighbours. Its own light does reach the others.
class PathTracer {
 public:
  // Keeps references to the scene. Lights the translucent surfaces now.
  // Throws InputError where the terms are out of range.
  PathTracer(const SurfaceScene& scene, const TransportTerms& terms, std::uint64_t seed = 0);

  // One path. The mean over draws of `random` is the radiance that arrives at the ray's origin.
  //   rays  grows by the rays that were traced
  Color Radiance(Ray ray, UniformStream& random, std::int64_t& rays) const;

 private:
  struct Vertex;
  Color LightsAt(const Vertex& vertex, UniformStream& random, std::int64_t& rays) const;
  bool Reaches(const Vertex& vertex, const Eigen::Vector3d& direction, double distance,
               std::int64_t& rays) const;

  const SurfaceScene& scene_;
  TransportTerms terms_;
  bool has_emitters_ = false;
  std::map<const Surface*, SubsurfaceSphere::Exitance> exitance_;
};

}  // namespace nerf
