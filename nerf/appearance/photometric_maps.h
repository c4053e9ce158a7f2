#pragma once

#include <string>
#include <vector>

#include "nerf/appearance/olat_capture.h"
#include "nerf/appearance/photometric_stereo.h"
#include "nerf/data/image.h"

namespace nerf::appearance {

// What photometric stereo says of each pixel. All linear, of the photographs' size; outside the
// mask, and where nothing could be said, everything is 0.
struct PhotometricMaps {
  Image normal;    // 3 channels, unit; x right, y up, z towards the camera
  Image albedo;    // 3 channels; 1 is a surface that is 1 in a picture when it faces a light of 1
  Image residual;  // 1 channel, relative to the albedo
  int pixels = 0;  // inside the mask
  int robust_pixels = 0;   // of them, those that the robust method solved
  int unknown_pixels = 0;  // of them, those without three lit observations
  double median_residual = 0;
};

// Solves a capture pixel by pixel: the normal from the mean of the channels, the albedo of each
// channel by least squares on the shading max(0, l . n) of the observations that agree with it.
// Holds the pixels inside the mask of all images as floats. Shows progress.
// Throws sfm::InputError: too few or coplanar lights; nothing inside the mask; an image that is
// black, or half saturated, there.
PhotometricMaps SolvePhotometricStereo(const OlatCapture& capture, InputEncoding encoding,
                                       const StereoOptions& options);

// What the numbers of a capture's 8-bit files mean, where nobody says: the encoding, sRGB or
// linear, in which least squares explain them better. Other files are linear, and so is the answer
// then. Throws as SolvePhotometricStereo does.
InputEncoding EncodingByResidual(const OlatCapture& capture);

// The surface under one directional light, linear: albedo max(0, l . n) E / pi.
Image RelitByNormals(const PhotometricMaps& maps, const DirectionalLight& light);

// Normals as people look at them: (n + 1) / 2 as the values of an 8-bit file; black outside.
Image NormalsToLookAt(const Image& normal);

}  // namespace nerf::appearance
