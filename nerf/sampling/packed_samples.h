#pragma once

#include <cstdint>
#include <vector>

namespace nerf {

// The samples of a batch of R rays, packed ray after ray; S in total.
struct PackedSamples {
  std::vector<std::int64_t> ray_begin;  // [R+1] first sample of each ray; the last entry is S
  std::vector<std::int64_t> ray;        // [S] the ray of each sample
  std::vector<float> position;          // [S,3] contracted, in the unit cube
  std::vector<float> t;                 // [S] distance of the sample along its ray
  std::vector<float> dt;                // [S] length of its interval

  std::int64_t Rays() const { return static_cast<std::int64_t>(ray_begin.size()) - 1; }
  std::int64_t Size() const { return static_cast<std::int64_t>(t.size()); }
};

// The first samples of each ray.
//   kept  [R] how many of each ray
PackedSamples KeepFront(const PackedSamples& samples, const std::vector<std::int64_t>& kept);

}  // namespace nerf
