#pragma once

#include <string>
#include <vector>

#include "nerf/scene/posed_images.h"
#include "nerf/synthetic/scene.h"

namespace nerf::synthetic {

// What a sample calls for, one effect each, so that a program which finds out can be told right
// from wrong.
enum class Occasion {
  kBuiltIn,     // the built-in scene: mirrors, a sky, a ground to the horizon
  kNothing,     // matt things on sand, under a painted tent: the simplest field is enough
  kView,        // the same with gloss, in which the sun shows broadly
  kBackground,  // nothing but a sky without end behind things on a small plate
  kUnbounded,   // a sky, and ground to the horizon
  kExposure,    // exposure and white balance change from photograph to photograph
  kMasks,       // people pass by, and masks say where
  kAlpha,       // what is not of the subject is transparent
  kRobust,      // people pass by
  kDepth,       // few photographs: what alone they leave open, sparse points say
  kHdr,         // radiance in EXR files, with much more light than white
  kPoses,       // the poses that come with the photographs are a little wrong
  kFootprint,   // a subject cut out by alpha, half of the time from four times as far
};

// By the names that a person uses: "built-in", "nothing", "view", ...
// Throws InputError listing the names where it is none of them.
Occasion OccasionFromName(const std::string& name);
std::string OccasionNames();

Scene SceneOf(Occasion occasion);

// How many photographs are taken, unless somebody says otherwise.
int UsualViews(Occasion occasion);

// Every eighth photograph, from the first on, is one to judge by: nobody passes by there, and its
// pose is right.
bool IsToJudgeBy(int view);

// How many times the usual distance from the subject a photograph is taken from.
double DistanceFactor(Occasion occasion, int view);

// How one photograph of a sample is taken.
struct Photography {
  Color gain = Color::Ones();      // of light, by exposure and white balance
  bool linear = false;             // radiance as it is, else sRGB in [0,1]
  bool alpha = false;              // 0 where a ray meets nothing
  bool mask = false;               // black where somebody passes by
  std::vector<Object> passers_by;  // who stands before the camera, and in no other photograph
};

//   view  index of the photograph; seed  of the sample
Photography PhotographyOf(Occasion occasion, int view, unsigned seed,
                          const Eigen::Isometry3d& world_from_camera);

}  // namespace nerf::synthetic
