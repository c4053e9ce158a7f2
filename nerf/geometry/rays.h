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
  std::vector<float> background;  // [R,3] the colour behind everything
  std::vector<float> jitter;      // [R] in [0,1]: offset of the first sample in its step
  // [R] width of a pixel at distance 1 along its ray, >= 0; empty: rays without a footprint.
  std::vector<float> spread;

  std::int64_t Size() const { return static_cast<std::int64_t>(jitter.size()); }
  void Resize(std::int64_t rays) {
    origin.resize(3 * rays);
    direction.resize(3 * rays);
    background.resize(3 * rays);
    jitter.resize(rays);
  }
};

// The largest coordinate of a ray origin; squares are then far from overflow.
inline constexpr float kFarthestOrigin = 1e9f;

// Throws InputError naming the view if its camera is farther out than kFarthestOrigin.
void CheckCameraCentre(const Eigen::Vector3d& centre_in_normalized, const std::string& view);

// Throws std::invalid_argument with the index of the first invalid ray: a value that is not finite,
// an origin beyond kFarthestOrigin, a direction that is not a unit vector (to 1e-3), a jitter
// outside [0,1]. Renderers call it once per batch.
void CheckRays(const RayBatch& rays);

}  // namespace nerf
