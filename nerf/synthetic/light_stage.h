#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "nerf/transport/scene_renderer.h"

namespace nerf::synthetic {

// How a built-in subject is photographed in a light stage.
struct LightStageOptions {
  int lights = 256;  // spread evenly over the sphere, 3..10,000
  int width = 320;   // pixels, up to 8192
  int height = 180;
  int paths = 256;               // a place, of the picture directly under an environment
  std::string environment = "";  // a map for that picture; empty: none is made
  std::string merl = "";         // a measured BRDF for the ball of gold; empty: gold

  // Of every picture alike. What lies behind the subject stays dark.
  TransportTerms terms{.emission = false, .bounces = 0};

  // Throws InputError, naming the flag, where a value is out of range.
  void Check() const;
};

// The built-in subject: four balls on a table, matt (Lambert), glazed (a rough coat on a red base),
// of gold (a rough metal, or what is given in its place) and of marble (translucent), without any
// light.
SurfaceScene LightStageSubject(std::shared_ptr<const Brdf> in_place_of_gold = nullptr);

// A camera before it, at the height of a person who leans over the table. World: x right, y up, z
// towards the camera.
struct StageCamera {
  Camera camera;
  Eigen::Isometry3d world_from_camera;
};
StageCamera LightStageCamera(int width, int height);

// `count` lights spread evenly over the sphere, each of intensity 1 (light_file.h).
std::vector<DirectionalLight> LightStageLights(int count);

// The subject under one light, and directly under an environment: one is the truth for what is
// relit from the other, where both have the same terms. Without bounces an image under one light
// has no noise.
//   paths  in each of a pixel's places
Image PhotographUnder(SurfaceScene& subject, const DirectionalLight& light,
                      const StageCamera& camera,
                      const TransportTerms& terms = LightStageOptions{}.terms);
SceneRendering PhotographUnder(
    SurfaceScene& subject, std::shared_ptr<const EnvironmentMap> environment,
    const StageCamera& camera, int paths, const TransportTerms& terms = LightStageOptions{}.terms,
    const std::function<bool()>& keep_on = [] { return true; });

// Writes a light-stage capture into a folder, which is made where it does not exist:
//   light_0000.exr, ...   linear, one light each
//   lights.txt            their directions (light_file.h)
//   truth/direct.exr      the subject directly under the environment, where one is given
//   light_stage.txt       the mark by which the folder is known as such a capture
// An earlier capture in the folder is replaced, and what it had more of is removed.
//   returns  false where keep_on ended it; the light file is written last, so that half a capture
//            is none
// Throws InputError: options out of range, the folder cannot be written, or it holds anything
// without that mark, or images that are no such capture's (nothing in it is touched then).
bool WriteLightStage(const std::filesystem::path& folder, const LightStageOptions& options,
                     const std::function<bool()>& keep_on);

}  // namespace nerf::synthetic
