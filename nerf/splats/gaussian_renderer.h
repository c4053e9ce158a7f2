#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "nerf/kernels/gaussian_blending.h"
#include "nerf/kernels/gaussians.h"
#include "nerf/splats/depth_order.h"
#include "nerf/splats/tile_lists.h"

namespace nerf {

// A picture as planes of floats: red, green, blue without background, the transmittance that is
// left for the background, and the sum of weight times distance. Rows and columns are padded to
// whole tiles and vectors; what is beyond width and height is of no meaning.
struct GaussianPicture {
  static constexpr int kRowPadding = 16;
  static constexpr int kPlanes = 5;
  static constexpr int kTransmittance = 3, kDistance = 4;

  int width = 0, height = 0;
  int stride = 0, rows = 0;   // padded
  std::vector<float> values;  // [kPlanes][rows][stride]

  void Resize(int new_width, int new_height);
  float* Plane(int plane) { return &values[static_cast<std::size_t>(plane) * rows * stride]; }
  const float* Plane(int plane) const {
    return &values[static_cast<std::size_t>(plane) * rows * stride];
  }
  float* Row(int plane, int y) { return Plane(plane) + static_cast<std::ptrdiff_t>(y) * stride; }
  const float* Row(int plane, int y) const {
    return Plane(plane) + static_cast<std::ptrdiff_t>(y) * stride;
  }
};

// The parameters of Gaussians, see kernels/gaussians.h.
struct GaussianParameters {
  int order = 0;                  // of the harmonics
  std::span<const float> values;  // [blocks][GaussianRows(order)][16]

  std::int64_t Blocks() const {
    return static_cast<std::int64_t>(values.size()) /
           (kernels::GaussianRows(order) * kernels::kGaussiansInBlock);
  }
  std::span<const float> Block(std::int64_t block) const {
    const std::size_t size =
        static_cast<std::size_t>(kernels::GaussianRows(order)) * kernels::kGaussiansInBlock;
    return values.subspan(static_cast<std::size_t>(block) * size, size);
  }
};

// [height][width]
struct GaussianSurface {
  // Of the Gaussian behind which less than half of the light is left, normalized units; 0: none.
  std::vector<float> median_distance;
  // The mean of the normals of what is seen, by its weight: the shortest axes of the Gaussians,
  // towards the camera. Of length 1 in the normalized frame; 0 where nothing is seen.
  std::vector<std::array<float, 3>> normal;
};

// Draws Gaussians, and the backward pass. Uses all threads; the results are the same bits for any
// number of them. Keeps the buffers of a picture, so that the next one allocates nothing.
class GaussianRenderer {
 public:
  // Gradients of one block: [GaussianRows(order)][16], and the length of the gradient by the
  // position in the picture, [16]. Called from several threads, once for each block of which
  // something is visible.
  using Sink = std::function<void(std::int64_t block, std::span<float> gradients,
                                  std::span<const float> on_screen)>;

  // The picture is valid until the next call.
  GaussianPicture& Draw(const kernels::GaussianCamera& camera,
                        const GaussianParameters& parameters);

  // After Draw, with the same arguments: where its surfaces are.
  GaussianSurface FindSurface(const kernels::GaussianCamera& camera,
                              const GaussianParameters& parameters) const;

  // After Draw, with the same arguments.
  //   dL_dpicture  of the picture's size
  //   returns      the gradient by the pose of the camera; 0 unless with_pose
  kernels::CameraGradient Backward(const kernels::GaussianCamera& camera,
                                   const GaussianParameters& parameters,
                                   const GaussianPicture& dL_dpicture, bool with_pose,
                                   const Sink& sink);

  // Of the last picture.
  std::int64_t Visible() const { return static_cast<std::int64_t>(sorted_.size()); }
  std::int64_t TileEntries() const { return tiles_.Entries(); }

 private:
  void ProjectAll(const kernels::GaussianCamera& camera, const GaussianParameters& parameters);
  kernels::GaussianMoments MomentsOf(std::uint32_t position) const;

  std::vector<kernels::ProjectedGaussian> projected_;
  DepthOrder order_;
  std::span<kernels::ProjectedGaussian> sorted_;
  TileLists tiles_;
  std::vector<kernels::TilePicture> pictures_;  // of the tiles
  std::vector<std::int64_t> needed_;            // entries of each tile
  GaussianPicture picture_;
  std::vector<kernels::GaussianMoments> moments_;  // by slot
  std::vector<std::uint32_t> position_of_;         // of each Gaussian in sorted_
};

}  // namespace nerf
