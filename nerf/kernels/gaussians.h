#pragma once

#include <array>
#include <cstdint>

namespace nerf::kernels {

// The parameters of Gaussians, in blocks of 16 Gaussians: [blocks][parameter][16]. A vector holds
// one parameter of neighbours, and all of a block is in one place. Gaussians beyond the last of a
// block have an opacity of 0.
//
//   mean       x, y, z, normalized units
//   log_scale  of the standard deviations along the three axes
//   rotation   quaternion w, x, y, z of the axes, of any length; of length 0 it is the identity
//   opacity    x in kMostOpacity / (1 + e^-x): always below 1, so that light passes everywhere
//   color      coefficients of real spherical harmonics, three colours each, plus 1/2:
//              rgb = max(0, 1/2 + sum_k basis_k(direction) color_k)
// Source: Kerbl et al. 2023, "3D Gaussian Splatting for Real-Time Radiance Field Rendering".
inline constexpr int kGaussiansInBlock = 16;
inline constexpr int kMeanRow = 0, kLogScaleRow = 3, kRotationRow = 6, kOpacityRow = 10,
                     kColorRow = 11;
inline constexpr int kMostHarmonicsOrder = 3;
constexpr int HarmonicsOf(int order) { return (order + 1) * (order + 1); }
constexpr int GaussianRows(int order) { return kColorRow + 3 * HarmonicsOf(order); }
inline constexpr int kMostGaussianRows = GaussianRows(kMostHarmonicsOrder);

inline constexpr float kMostOpacity = 0.99f;
// Where alpha is less, it is taken for 0, but for what the footprint of the pixel takes from it: a
// Gaussian that is far away is cut at the same part of itself as one that is near.
inline constexpr float kLeastAlpha = 1.0f / 255;
// Blending ends where the transmittance of all pixels of a row of a tile is below this.
inline constexpr float kStopTransmittance = 1e-4f;
// Variance of the footprint of a pixel, squared pixels; a box has 1/12. More would blur: 0.2 costs
// 0.1 to 0.3 dB. With less the sum over pixel centres of what is much smaller than a pixel depends
// on where it is between them (with 0.1 by up to 28 %); its average is right in any case.
inline constexpr float kPixelVariance = 0.1f;

// Where a camera stands and how it maps points to pixels, see LensDistortion.
struct GaussianCamera {
  std::array<float, 9> rotation{};     // camera_from_normalized, row-major, OpenCV axes
  std::array<float, 3> translation{};  // of the same
  std::array<float, 3> center{};       // in normalized units
  float fx = 1, fy = 1, cx = 0, cy = 0;
  int width = 0, height = 0;
  // Means nearer than this are not drawn: along the axis of perspective lenses, from the centre of
  // fisheyes. Normalized units.
  float near = 0.02f;
  bool is_fisheye = false;
  bool is_pinhole = true;  // no distortion
  std::array<float, 5> numerator{1, 0, 0, 0, 0};
  std::array<float, 4> denominator{1, 0, 0, 0};
  std::array<float, 2> tangential{}, prism{};
  // The lens is evaluated no farther out on the ideal plane, and continued linearly: there its
  // formula may fold, and the linearization of a Gaussian is of no use.
  std::array<float, 2> most_ideal{1, 1};
};

// A Gaussian as one camera sees it. At the offset (dx, dy) of a pixel's centre
//   log2 alpha = log2_opacity + xx dx^2 + xy dx dy + yy dy^2,  0 where that is below `least`
struct alignas(64) ProjectedGaussian {
  float x = 0, y = 0;  // pixels
  float xx = 0, xy = 0, yy = 0;
  float log2_opacity = 0;
  float least = 0;
  std::array<float, 3> rgb{};
  float distance = 0;                // of the mean from the camera, normalized units
  float radius_x = 0, radius_y = 0;  // of what is not cut, pixels
  std::uint32_t index = 0;           // of the Gaussian
  std::uint32_t first_slot = 0;      // of the gradients of its tiles
  std::uint32_t tiles = 0;           // how many it touches
};
static_assert(sizeof(ProjectedGaussian) == 64);

// What blending backwards finds of a Gaussian in a tile: with g = dL/d(ln alpha) of each pixel,
// moments of g and the gradients of what is blended.
struct GaussianMoments {
  float sum = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;  // sum of g, g dx, g dy, g dx^2, ...
  std::array<float, 3> rgb{};
  float distance = 0;
};

// The gradient of the loss by a pose, in camera axes: of a point p it is moved to
// p + turned x p + moved.
struct CameraGradient {
  std::array<double, 3> turned{}, moved{};
};

}  // namespace nerf::kernels
