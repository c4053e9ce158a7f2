#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "nerf/model/model.h"
#include "nerf/scene/dataset.h"

namespace nerf::test {

// The colour of a ray in closed form: straight (not premultiplied) RGBA in [0,1], in the normalized
// frame.
using RadianceAlong =
    std::function<Eigen::Vector4f(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction)>;

// Cameras on a spiral that look at the origin, OpenCV axes.
std::vector<Eigen::Isometry3d> CameraRing(int count, double radius, double height);

// Photographs of an analytic scene in memory, with every fourth camera held out.
struct AnalyticCapture {
  Dataset data;
  std::vector<View> held_out;
  SceneFacts scene;

  AnalyticCapture(const std::vector<Eigen::Isometry3d>& cameras, int width, int height,
                  const RadianceAlong& radiance, bool has_alpha = false, int hold_out_every = 4);
};

// PSNR of a model's views on black against these photographs, over all pixels.
double PsnrOver(const Model& model, const std::vector<View>& views);

}  // namespace nerf::test
