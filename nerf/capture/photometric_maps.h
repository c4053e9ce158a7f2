#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "nerf/capture/olat_capture.h"
#include "nerf/capture/photometric_stereo.h"
#include "nerf/image/image.h"

namespace nerf {

// The results of photometric stereo for each pixel: linear images of the size of the photographs.
// All values are 0 outside the mask and where no normal was found.
struct PhotometricMaps {
  Image normal;    // 3 channels, unit; x right, y up, z towards the camera
  Image albedo;    // 3 channels; a surface of albedo 1 that faces a light of intensity 1 has the
                   // value 1
  Image residual;  // 1 channel, relative to the albedo
  int pixels = 0;  // inside the mask
  int robust_pixels = 0;    // of them, solved by the robust method
  int unsolved_pixels = 0;  // of them, without a normal
  double median_residual = 0;
};

// Default memory for observations, bytes.
inline constexpr std::int64_t kObservationBytes = std::int64_t{1} << 30;

// Solves a capture pixel by pixel: the normal from the mean of the channels, the albedo of each
// channel by least squares on the shading max(0, l . n), without outliers.
//   memory  bytes for observations, 13 for each pixel and light. If they do not fit, the pixels are
//           solved in parts, and the images are read again for each part. The maps and one image
//           are not included.
// Shows progress. Throws InputError if there are too few lights or they are coplanar, the mask is
// empty, or the subject is black or mostly saturated in an image (only integers can be saturated).
PhotometricMaps SolvePhotometricStereo(const OlatCapture& capture, InputEncoding encoding,
                                       const StereoOptions& options,
                                       std::int64_t memory = kObservationBytes);

// Guesses the encoding of 8-bit images, sRGB or linear: the one with the smaller least-squares
// residual on a subset of the pixels. Other files are linear. Throws as SolvePhotometricStereo
// does.
InputEncoding EncodingByResidual(const OlatCapture& capture);

// The surface under a directional light, linear: albedo max(0, l . n) E / pi.
Image RelitByNormals(const PhotometricMaps& maps, const DirectionalLight& light);

// Normals as a picture: (n + 1) / 2 as sRGB values; black outside.
Image NormalsAsColors(const Image& normal);

}  // namespace nerf
