#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "nerf/capture/olat_capture.h"
#include "nerf/capture/photometric_stereo.h"
#include "nerf/image/image.h"

namespace nerf {

// What photometric stereo says of each pixel. All linear, of the photographs' size; outside the
// mask, and where nothing could be said, everything is 0.
struct PhotometricMaps {
  Image normal;    // 3 channels, unit; x right, y up, z towards the camera
  Image albedo;    // 3 channels; 1 is a surface that is 1 in a picture when it faces a light of 1
  Image residual;  // 1 channel, relative to the albedo
  int pixels = 0;  // inside the mask
  int robust_pixels = 0;   // of them, those that the robust method solved
  int unknown_pixels = 0;  // of them, those of which nothing could be said
  double median_residual = 0;
};

// Bytes for observations where nobody says otherwise.
inline constexpr std::int64_t kObservationBytes = std::int64_t{1} << 30;

// Solves a capture pixel by pixel: the normal from the mean of the channels, the albedo of each
// channel by least squares on the shading max(0, l . n) of the observations that agree with it.
//   memory  bytes for the observations of pixels, of which each takes 13 a light; where they are
//           more, so many pixels at a time are solved as fit, and the images are read again for
//           each such part. The maps and an image being read come beside them.
// Shows progress. Throws InputError: too few or coplanar lights; nothing inside the mask; an
// image that is black there, or half saturated (of integers: floats have no largest value).
PhotometricMaps SolvePhotometricStereo(const OlatCapture& capture, InputEncoding encoding,
                                       const StereoOptions& options,
                                       std::int64_t memory = kObservationBytes);

// What the numbers of a capture's 8-bit files mean, where nobody says: the encoding, sRGB or
// linear, in which least squares explain them better, on some of the pixels. Other files are
// linear, and so is the answer then. Throws as SolvePhotometricStereo does.
InputEncoding EncodingByResidual(const OlatCapture& capture);

// The surface under one directional light, linear: albedo max(0, l . n) E / pi.
Image RelitByNormals(const PhotometricMaps& maps, const DirectionalLight& light);

// Normals as people look at them: (n + 1) / 2 as the values of an 8-bit file; black outside.
Image NormalsToLookAt(const Image& normal);

}  // namespace nerf
