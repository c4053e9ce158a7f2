#pragma once

#include <string>
#include <vector>

#include "nerf/scene/posed_images.h"
#include "nerf/synthetic/scene.h"

namespace nerf::synthetic {

// The variants of the generated capture. Most need exactly one effect, so that the verdicts of
// `nerf inspect` and the benefit of each effect can be checked.
enum class Scenario {
  kBuiltIn,           // the built-in scene: a mirror, a sky, ground up to the dome
  kNothing,           // diffuse objects on sand under a painted dome: needs no effect
  kViewDependence,    // kNothing with glossy objects: broad highlights of the sun
  kBackground,        // objects on a small plate before a sky that is practically infinitely far
  kUnbounded,         // a sky, and ground up to the horizon
  kExposure,          // exposure and white balance change from photograph to photograph
  kMasks,             // people pass by, and masks mark them
  kAlpha,             // everything but the subject is transparent
  kRobust,            // people pass by, without masks
  kDepthSupervision,  // few photographs, so that the sparse points matter
  kHdr,               // radiance in EXR files, far brighter than white
  kPoseRefinement,    // the poses that come with the photographs are slightly wrong
  kAntiAliasing,      // a subject cut out by alpha, half of the photographs from four times as far
  // Captures that are hard for structure from motion:
  kTextureless,  // hardly any texture
  kRepeated,     // a pattern that repeats
  kMirrors,      // everything mirrors its surroundings
  kTwoGroups,    // photographs from two sides that hardly overlap
  kMotionBlur,   // every third photograph is blurred by the movement of the camera
};

// The scenario with a name as the command line has it: "built-in", "view_dependence", ... The names
// that scenarios had before ("view", "poses", "footprint", "depth") are accepted for one version.
// Throws InputError listing the names if there is no such scenario.
Scenario ScenarioFromName(const std::string& name);
// All names but the former ones, separated by commas.
std::string ScenarioNames();

Scene SceneFor(Scenario scenario);

// How many photographs a capture has unless --views is given.
int DefaultViewCount(Scenario scenario);

// Every eighth photograph, beginning with the first, is held out of training: nobody passes by in
// it, and its pose is exact.
bool IsHeldOut(int view);

// The distance of a camera from the subject, relative to the ordinary one.
double DistanceFactor(Scenario scenario, int view);

// The azimuth of a view where it would be at `azimuth` on a full ring, radians.
double AzimuthIn(Scenario scenario, double azimuth);

// How one photograph is taken.
struct PhotoSettings {
  Color gain = Color::Ones();  // factor of the radiance, from exposure and white balance
  bool linear = false;         // stores radiance; else sRGB, clipped to [0,1]
  bool alpha = false;          // with an alpha channel: 0 where a ray hits nothing
  bool mask = false;           // with a mask that is black on passers-by
  // The rotation of the camera while the photograph is taken: an angle, radians, about an axis in
  // its own axes.
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  std::vector<Object> passers_by;  // stand before this camera and are in no other photograph
};

//   view  index of the photograph
//   seed  of the capture
PhotoSettings PhotoSettingsFor(Scenario scenario, int view, unsigned seed,
                               const Eigen::Isometry3d& world_from_camera);

}  // namespace nerf::synthetic
