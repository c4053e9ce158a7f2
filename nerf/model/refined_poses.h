#pragma once

#include <Eigen/Geometry>
#include <string>

#include "nerf/model/model.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// Applies a model's pose refinement to its photographs, in the input's frame and units: to the
// poses of training photographs and to the focal lengths of all lenses, which held-out photographs
// share. Focal lengths are scaled as for a lens without distortion. Returns `posed` unchanged if
// the model has no pose refinement.
PosedImages RefinedPoses(const Model& model, PosedImages posed);

// The same for one view: its pose if it was trained on, and its focal length.
void RefineView(const Model& model, const std::string& name, std::int64_t lens,
                Eigen::Isometry3d& normalized_from_camera, Camera& camera);

}  // namespace nerf
