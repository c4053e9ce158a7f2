#include "nerf/sample/occasion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "nerf/sample/hash.h"
#include "sfm/input_error.h"

namespace nerf::sample {
namespace {

using Eigen::Vector3d;

const std::vector<std::pair<std::string, Occasion>> kNames = {
    {"built-in", Occasion::kBuiltIn},  {"nothing", Occasion::kNothing},
    {"view", Occasion::kView},         {"background", Occasion::kBackground},
    {"exposure", Occasion::kExposure}, {"masks", Occasion::kMasks},
    {"alpha", Occasion::kAlpha},       {"robust", Occasion::kRobust},
    {"depth", Occasion::kDepth},       {"hdr", Occasion::kHdr},
};

constexpr double kStops = 1.0;          // by which exposures differ from their mean, at most
constexpr double kWhiteBalance = 0.15;  // and channels, a part of their light
constexpr int kEveryToJudgeBy = 8;

// The i-th random number of a view, in [-1, 1).
double Signed(int i, int view, unsigned seed) {
  return 2 * UnitFromHash(Hash(view, i, 7, seed)) - 1;
}

// A ball of one colour, a third of the way to what the camera looks at.
Object PasserBy(int view, unsigned seed, const Eigen::Isometry3d& world_from_camera) {
  const Vector3d in_camera(0.35 * Signed(0, view, seed), 0.25 * Signed(1, view, seed), 1.3);
  Object ball;
  ball.shape = Sphere{world_from_camera * in_camera, 0.16};
  ball.material.albedo =
      Plain{Color(0.8, 0.45 + 0.4 * Signed(2, view, seed), 0.45 + 0.4 * Signed(3, view, seed))};
  return ball;
}

}  // namespace

Occasion OccasionFromName(const std::string& name) {
  const auto found = std::ranges::find(kNames, name, &std::pair<std::string, Occasion>::first);
  if (found != kNames.end()) return found->second;
  throw sfm::InputError("--calls-for {}: choose one of {}", name, OccasionNames());
}

std::string OccasionNames() {
  std::string names;
  for (const auto& [name, occasion] : kNames) names += (names.empty() ? "" : ", ") + name;
  return names;
}

int UsualViews(Occasion occasion) { return occasion == Occasion::kDepth ? 9 : 36; }

Scene SceneOf(Occasion occasion) {
  Scene scene = BuiltInScene();
  if (occasion == Occasion::kAlpha) {
    std::erase_if(scene.objects,
                  [](const Object& object) { return std::holds_alternative<Disc>(object.shape); });
    scene.dome.reset();
  }
  if (occasion == Occasion::kBackground) {
    // As far as the eye can tell, without end.
    scene.dome->radius = 1000;
    for (Object& object : scene.objects) {
      if (Disc* const ground = std::get_if<Disc>(&object.shape)) ground->radius = 300;
    }
  }
  for (Object& object : scene.objects) {
    if (occasion == Occasion::kBuiltIn) break;
    object.material.mirror = Color::Zero();
    // A coat on everything but the slab.
    const bool slab = &object == &scene.objects.front();
    if (occasion == Occasion::kView && !slab) {
      object.material.mirror = Color(0.25, 0.25, 0.25);
      object.material.highlight_exponent = 60;
    }
  }
  if (occasion == Occasion::kHdr) scene.sun.irradiance *= 8;
  return scene;
}

Photography PhotographyOf(Occasion occasion, int view, unsigned seed,
                          const Eigen::Isometry3d& world_from_camera) {
  Photography photography;
  photography.linear = occasion == Occasion::kHdr;
  photography.alpha = occasion == Occasion::kAlpha;
  photography.mask = occasion == Occasion::kMasks;
  if (occasion == Occasion::kExposure) {
    photography.gain.setConstant(std::exp2(kStops * Signed(4, view, seed)));
    for (int c = 0; c < 3; ++c) {
      photography.gain[c] *= 1 + kWhiteBalance * Signed(5 + c, view, seed);
    }
  }
  const bool passes = occasion == Occasion::kMasks || occasion == Occasion::kRobust;
  if (passes && view % kEveryToJudgeBy != 0) {
    photography.passer_by = PasserBy(view, seed, world_from_camera);
  }
  return photography;
}

}  // namespace nerf::sample
