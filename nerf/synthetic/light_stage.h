#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "nerf/transport/scene_renderer.h"

namespace nerf::synthetic {

// How the built-in subject is photographed in a light stage: under one light at a time.
struct LightStageOptions {
  int lights = 256;  // spread evenly over the sphere, 3..10,000
  int width = 320;   // pixels, up to 8192
  int height = 180;
  int paths = 256;               // for each place in a pixel, of the picture under an environment
  std::string environment = "";  // the file of that environment; empty: no such picture
  std::string merl = "";         // the file of a measured BRDF for the third ball; empty: gold

  // Of all pictures. The background is black.
  TransportTerms terms{.emission = false, .bounces = 0};

  // Throws InputError, naming the flag, if a value is out of range.
  void Check() const;
};

// The built-in subject, without lights: four balls on a table. From left to right they are diffuse
// (Lambert), glazed (a rough coat on a red base), of gold (a rough metal) and of marble
// (translucent).
//   third_ball  a BRDF in place of gold
SurfaceScene LightStageSubject(std::shared_ptr<const Brdf> third_ball = nullptr);

// A camera in front of the table that looks slightly down. World: x right, y up, z to the camera.
struct StageCamera {
  Camera camera;
  Eigen::Isometry3d world_from_camera;
};
StageCamera LightStageCamera(int width, int height);

// `count` lights spread evenly over the sphere, each of intensity 1 (light_file.h).
std::vector<DirectionalLight> LightStageLights(int count);

// Render the subject under one light, and directly under an environment. With the same terms, the
// second is the ground truth for relighting from the first. Both replace the lights of `subject`.
// Without bounces, an image under one light is free of noise.
//   paths    for each place in a pixel
//   keep_on  called between passes; false ends the rendering
Image RenderUnder(SurfaceScene& subject, const DirectionalLight& light, const StageCamera& camera,
                  const TransportTerms& terms = LightStageOptions{}.terms);
SceneRendering RenderUnder(
    SurfaceScene& subject, std::shared_ptr<const EnvironmentMap> environment,
    const StageCamera& camera, int paths, const TransportTerms& terms = LightStageOptions{}.terms,
    const std::function<bool()>& keep_on = [] { return true; });

// Writes a light-stage capture into a folder, which is created if it does not exist:
//   light_0000.exr, ...   linear, under one light each
//   lights.txt            directions of the lights (light_file.h)
//   truth/direct.exr      the subject directly under the environment, if one is given
//   light_stage.txt       marks the folder as such a capture
// An earlier capture in the folder is replaced, and its remaining files are removed.
//   keep_on  called before each image; false ends the work
//   returns  false if keep_on ended it. The light file is written last, so that an incomplete
//            capture is not mistaken for a complete one
// Throws InputError if options are out of range, the folder cannot be written, or it contains files
// that are not from such a capture (then nothing in it is changed).
bool WriteLightStage(const std::filesystem::path& folder, const LightStageOptions& options,
                     const std::function<bool()>& keep_on);

}  // namespace nerf::synthetic
