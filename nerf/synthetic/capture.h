#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <vector>

#include "nerf/image/image.h"
#include "nerf/scene/posed_images.h"
#include "nerf/synthetic/occasion.h"
#include "nerf/synthetic/sample_options.h"
#include "nerf/synthetic/scene.h"

namespace nerf::synthetic {

// One rendered photograph, and what is true of the ray through each pixel's centre.
struct View {
  Image photo;  // what a camera would store before rounding: 3 channels, or 4 with alpha; sRGB in
                // [0,1], or linear radiance
  std::optional<Image> mask;  // 1 channel, sRGB: 0 where somebody passes by, else 1
  Image depth;   // 1 channel, linear: distance along the ray, scene units; 0 where nothing is met
  Image normal;  // 3 channels, linear: unit, in world axes, on the side of the camera
  Image albedo;  // 3 channels, linear: reflectance in [0,1]; on the sky its radiance
};

// A whole capture in memory.
struct Capture {
  PosedImages posed;        // true poses; paths are empty, for there are no files
  std::vector<View> views;  // one for each of posed.images
};

// Renders one view. What is true of it is true of the scene without a passer-by.
//   samples_per_pixel  rays averaged in linear light, spread evenly over the pixel
//   seed               moves the rays within the pixels; another one for each view
// Throws InputError where the camera has no ray for a pixel.
View RenderView(const Scene& scene, const Camera& camera,
                const Eigen::Isometry3d& world_from_camera, int samples_per_pixel, unsigned seed,
                const Photography& photography = {});

// Renders the images of `posed` on several threads and hands over each as it is done, in any order
// but never two at a time.
//   consume  called with the index of the image and its view; what it throws ends the rendering
void RenderViews(const Scene& scene, const PosedImages& posed, const SampleOptions& options,
                 const std::function<void(int, View)>& consume);

// The scene of options.occasion photographed from CameraRings(options), in memory.
// The same options give the same pixels, whatever the number of threads. Throws InputError.
Capture MakeCapture(const SampleOptions& options);

}  // namespace nerf::synthetic
