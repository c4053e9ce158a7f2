// The colour of Gaussians from a direction, on vectors. Included once for each SIMD level.
#if defined(NERF_KERNELS_GAUSSIAN_HARMONICS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NERF_KERNELS_GAUSSIAN_HARMONICS_INL_H_
#undef NERF_KERNELS_GAUSSIAN_HARMONICS_INL_H_
#else
#define NERF_KERNELS_GAUSSIAN_HARMONICS_INL_H_
#endif

#include <hwy/highway.h>

#include "nerf/kernels/gaussian_vectors-inl.h"
#include "nerf/kernels/gaussians.h"

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {

// Real spherical harmonics up to degree 3 of the direction (x, y, z) from the camera to the mean.
// Source: Sloan 2013, "Efficient Spherical Harmonic Evaluation", appendix A2.
struct Harmonics {
  V x, y, z, inverse_length;
  V basis[HarmonicsOf(kMostHarmonicsOrder)];
};

HWY_INLINE Harmonics HarmonicsAt(const GaussianCamera& camera, int order, V mean_x, V mean_y,
                                 V mean_z) {
  const auto c = [](float value) HWY_ATTR { return Constant(value); };
  Harmonics h;
  h.basis[0] = c(0.28209479177387814f);
  if (order == 0) return h;
  const V dx = mean_x - c(camera.center[0]), dy = mean_y - c(camera.center[1]),
          dz = mean_z - c(camera.center[2]);
  h.inverse_length = c(1) / hn::Sqrt(hn::Max(dx * dx + dy * dy + dz * dz, c(1e-30f)));
  h.x = dx * h.inverse_length;
  h.y = dy * h.inverse_length;
  h.z = dz * h.inverse_length;
  const V x = h.x, y = h.y, z = h.z;
  h.basis[1] = c(-0.48860251190291987f) * y;
  h.basis[2] = c(0.48860251190291987f) * z;
  h.basis[3] = c(-0.48860251190291987f) * x;
  if (order == 1) return h;
  const V xx = x * x, yy = y * y, zz = z * z;
  h.basis[4] = c(1.0925484305920792f) * x * y;
  h.basis[5] = c(-1.0925484305920792f) * y * z;
  h.basis[6] = c(0.94617469575755997f) * zz - c(0.31539156525251999f);
  h.basis[7] = c(-1.0925484305920792f) * x * z;
  h.basis[8] = c(0.54627421529603959f) * (xx - yy);
  if (order == 2) return h;
  h.basis[9] = c(0.59004358992664352f) * y * (yy - c(3) * xx);
  h.basis[10] = c(2.8906114426405538f) * x * y * z;
  h.basis[11] = c(0.45704579946446572f) * y * (c(1) - c(5) * zz);
  h.basis[12] = c(0.3731763325901154f) * z * (c(5) * zz - c(3));
  h.basis[13] = c(0.45704579946446572f) * x * (c(1) - c(5) * zz);
  h.basis[14] = c(1.4453057213202769f) * z * (xx - yy);
  h.basis[15] = c(0.59004358992664352f) * x * (c(3) * yy - xx);
  return h;
}

// max(0, 1/2 + sum_k basis_k color_k).
//   color  rows of a block, kGaussiansInBlock apart
HWY_INLINE void ColorOf(const Harmonics& h, int order, const float* color, V (&rgb)[3]) {
  const D d;
  for (V& channel : rgb) channel = Constant(0.5f);
  for (int k = 0; k < HarmonicsOf(order); ++k) {
    for (int channel = 0; channel < 3; ++channel) {
      const float* const row = color + kGaussiansInBlock * (3 * k + channel);
      rgb[channel] = hn::MulAdd(h.basis[k], hn::LoadU(d, row), rgb[channel]);
    }
  }
  for (V& channel : rgb) channel = hn::Max(channel, hn::Zero(d));
}

// The gradients by the coefficients, written, and by the vector from the camera to the mean.
//   dL_drgb  of the colour
HWY_INLINE void ColorGradient(const Harmonics& h, int order, const float* color,
                              const V (&dL_drgb)[3], float* by_color, V (&by_direction)[3]) {
  const D d;
  V rgb[3], g[3];
  ColorOf(h, order, color, rgb);
  for (int channel = 0; channel < 3; ++channel) {
    g[channel] = hn::IfThenElseZero(hn::Gt(rgb[channel], hn::Zero(d)), dL_drgb[channel]);
  }
  V by_basis[HarmonicsOf(kMostHarmonicsOrder)];
  for (int k = 0; k < HarmonicsOf(order); ++k) {
    by_basis[k] = hn::Zero(d);
    for (int channel = 0; channel < 3; ++channel) {
      const std::size_t row = kGaussiansInBlock * (3 * static_cast<std::size_t>(k) + channel);
      hn::StoreU(g[channel] * h.basis[k], d, by_color + row);
      by_basis[k] = hn::MulAdd(g[channel], hn::LoadU(d, color + row), by_basis[k]);
    }
  }
  for (V& axis : by_direction) axis = hn::Zero(d);
  if (order == 0) return;
  const auto c = [](float value) HWY_ATTR { return Constant(value); };
  const V x = h.x, y = h.y, z = h.z;
  const V* const b = by_basis;
  V by_x = c(-0.48860251190291987f) * b[3];
  V by_y = c(-0.48860251190291987f) * b[1];
  V by_z = c(0.48860251190291987f) * b[2];
  if (order >= 2) {
    const V a = c(1.0925484305920792f);
    by_x = by_x + a * (y * b[4] - z * b[7] + x * b[8]);
    by_y = by_y + a * (x * b[4] - z * b[5] - y * b[8]);
    by_z = by_z + c(1.8923493915151199f) * z * b[6] - a * (y * b[5] + x * b[7]);
  }
  if (order >= 3) {
    const V xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z, yz = y * z;
    const V edge = c(1.7701307697799307f), inner = c(0.45704579946446572f),
            product = c(2.8906114426405538f);
    by_x = by_x - c(2) * edge * xy * b[9] + product * yz * b[10] +
           inner * (c(1) - c(5) * zz) * b[13] + product * xz * b[14] + edge * (yy - xx) * b[15];
    by_y = by_y + edge * (yy - xx) * b[9] + product * xz * b[10] +
           inner * (c(1) - c(5) * zz) * b[11] - product * yz * b[14] + c(2) * edge * xy * b[15];
    by_z = by_z + product * xy * b[10] - c(10) * inner * (yz * b[11] + xz * b[13]) +
           c(0.3731763325901154f) * (c(15) * zz - c(3)) * b[12] +
           c(1.4453057213202769f) * (xx - yy) * b[14];
  }
  const V along = by_x * x + by_y * y + by_z * z;
  by_direction[0] = (by_x - along * x) * h.inverse_length;
  by_direction[1] = (by_y - along * y) * h.inverse_length;
  by_direction[2] = (by_z - along * z) * h.inverse_length;
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();
#endif
