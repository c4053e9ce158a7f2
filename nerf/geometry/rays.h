#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace nerf {

// Rays in the normalized frame (SceneNormalization), lengths in its units.
struct RayBatch {
  std::vector<float> origin;      // [R,3]
  std::vector<float> direction;   // [R,3] unit vectors
  std::vector<float> background;  // [R,3] what is seen where the ray meets nothing
  std::vector<float> jitter;      // [R] in [0,1]: where in its first step each ray starts
  // [R] width of a pixel at distance 1 along its ray, >= 0; empty: rays of no pixels.
  std::vector<float> spread;

  std::int64_t Size() const { return static_cast<std::int64_t>(jitter.size()); }
  void Resize(std::int64_t rays) {
    origin.resize(3 * rays);
    direction.resize(3 * rays);
    background.resize(3 * rays);
    jitter.resize(rays);
  }
};

// The farthest that a ray may begin, in each coordinate: squares are then far from overflowing.
inline constexpr float kFarthestOrigin = 1e9f;

// Throws InputError naming the view whose camera stands farther out.
void CheckCameraCentre(const Eigen::Vector3d& centre_in_normalized, const std::string& view);

// Throws std::invalid_argument with the index of the first ray that is none: a number that is not
// finite, an origin beyond kFarthestOrigin, a direction that is no unit vector (to 1e-3), a jitter
// outside [0,1]. What renders rays calls it once a batch.
void CheckRays(const RayBatch& rays);

}  // namespace nerf
