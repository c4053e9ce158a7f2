#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "nerf/scene/posed_images.h"

namespace nerf {

// A pixel whose distance is known, from a sparse point that its photograph observes.
struct DepthObservation {
  std::int64_t pixel = 0;  // y * width + x
  float distance = 0;      // from the camera centre, normalized units
};

// A photograph in memory as training reads it: downscaled, RGBA as 16-bit floats. Where a capture
// does not fit into memory, each view stores a random subset of its pixels, stratified: of as many
// runs of equal length as pixels are stored, row after row, one pixel each. Training draws only a
// few million pixels in all, so a subset serves as well.
struct View {
  std::string name;
  Camera camera;                             // of the downscaled image
  Eigen::Isometry3d normalized_from_camera;  // OpenCV axes
  std::int64_t lens = 0;                     // index of the camera among those of the input
  std::vector<Eigen::half> rgba;             // [stored,4], straight alpha
  std::uint64_t seed = 0;                    // of the random subset
  std::vector<std::uint32_t> valid_pixels;   // the pixels to choose from, ascending; empty: all
  std::vector<DepthObservation> depth_observations;  // for depth supervision

  // Number of stored pixels.
  std::int64_t StoredCount() const { return static_cast<std::int64_t>(rgba.size() / 4); }
  // The position of stored pixel k in the image: y * width + x.
  std::int64_t PixelIndex(std::int64_t k) const;
  // The index of a stored pixel at a position of the image or near it.
  std::int64_t StoredNear(std::int64_t pixel) const;

 private:
  std::int64_t CandidateCount() const;
};

}  // namespace nerf
