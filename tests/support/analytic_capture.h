#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "nerf/model/model.h"
#include "nerf/scene/dataset.h"

namespace nerf::test {

// What a ray sees, in closed form: straight RGBA in [0,1], in the normalized frame.
using SeenAlong =
    std::function<Eigen::Vector4f(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction)>;

// Cameras on a rising ring that look at the origin, OpenCV axes.
std::vector<Eigen::Isometry3d> CameraRing(int count, double radius, double height);

// Photographs of what can be written down, as training sees them: no files, and every fourth camera
// held out.
struct AnalyticCapture {
  Dataset data;
  std::vector<View> held_out;
  SceneFacts scene;

  AnalyticCapture(const std::vector<Eigen::Isometry3d>& cameras, int width, int height,
                  const SeenAlong& seen, bool has_alpha = false, int hold_out_every = 4);
};

// PSNR of a model's views, laid over black, against those photographs, over all their pixels.
double PsnrOver(const Model& model, const std::vector<View>& views);

}  // namespace nerf::test
