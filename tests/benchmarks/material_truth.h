#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nerf/model/scene_model.h"
#include "nerf/pipeline/surface_extraction.h"
#include "nerf/relight/light_transport.h"
#include "nerf/relight/material_field.h"

namespace nerf {

// A test view: what is seen at its pixels.
struct TestView {
  std::string name;
  Camera camera;
  Image opacity;
  std::vector<std::int64_t> pixels;  // that show the surface
  torch::Tensor position, normal, to_camera, vertex;
};

// The depth of the model gives the position, the signed distance the normal.
TestView LookFrom(const SceneModel& model, const ExtractedSurface& surface, const MeshRays& rays,
                  const PosedImage& image, const Camera& camera);

// What was found of a scene.
struct FoundScene {
  const ExtractedSurface& surface;
  const LightTransport& transport;
  MaterialField& field;
  double normal_offset;  // MaterialOptions
  Eigen::Matrix3d world_from_normalized;
};

// Prints how far it is from the truth in a folder (material_fit.cpp).
void CompareWithTruth(const std::filesystem::path& truth, const FoundScene& found,
                      std::vector<TestView> views);

}  // namespace nerf
