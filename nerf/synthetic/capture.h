#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <vector>

#include "nerf/image/image.h"
#include "nerf/scene/posed_images.h"
#include "nerf/synthetic/sample_options.h"
#include "nerf/synthetic/scenario.h"
#include "nerf/synthetic/scene.h"

namespace nerf::synthetic {

// One rendered photograph, and the ground truth of the ray through each pixel's centre, which does
// not include passers-by.
struct View {
  Image photo;  // what a camera stores, before rounding: 3 channels, or 4 with alpha; sRGB in
                // [0,1], or linear radiance
  std::optional<Image> mask;  // 1 channel, sRGB: 0 on passers-by, else 1
  Image depth;   // 1 channel, linear: distance along the ray, scene units; 0 if nothing is hit
  Image normal;  // 3 channels, linear: unit, world axes, facing the camera
  Image albedo;  // 3 channels, linear: reflectance in [0,1]; the radiance of the dome
};

// A whole capture in memory.
struct Capture {
  PosedImages posed;        // true poses; paths are empty, as there are no files
  std::vector<View> views;  // of each of posed.images
};

// Renders one view.
//   samples_per_pixel  rays averaged in linear light, spread evenly over the pixel
//   seed               of the positions of the rays in the pixels; views should differ in it
// Throws InputError if the camera has no ray for a pixel.
View RenderView(const Scene& scene, const Camera& camera,
                const Eigen::Isometry3d& world_from_camera, int samples_per_pixel, unsigned seed,
                const PhotoSettings& settings = {});

// Renders the images of `posed` on several threads and passes on each as it is finished: in any
// order, but never two at a time.
//   consume  called with the index of an image and its view; an exception from it stops the
//            rendering and is passed on
void RenderViews(const Scene& scene, const PosedImages& posed, const SampleOptions& options,
                 const std::function<void(int, View)>& consume);

// Renders the scene of options.scenario from CameraRings(options), in memory. The pixels depend on
// the options alone, not on the number of threads. Throws InputError.
Capture MakeCapture(const SampleOptions& options);

}  // namespace nerf::synthetic
