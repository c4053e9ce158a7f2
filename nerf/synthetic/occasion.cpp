#include "nerf/synthetic/occasion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/synthetic/hash.h"

namespace nerf::synthetic {
namespace {

using Eigen::Vector3d;

const std::vector<std::pair<std::string, Occasion>> kNames = {
    {"built-in", Occasion::kBuiltIn},
    {"nothing", Occasion::kNothing},
    {"view", Occasion::kView},
    {"background", Occasion::kBackground},
    {"unbounded", Occasion::kUnbounded},
    {"exposure", Occasion::kExposure},
    {"masks", Occasion::kMasks},
    {"alpha", Occasion::kAlpha},
    {"robust", Occasion::kRobust},
    {"depth", Occasion::kDepth},
    {"hdr", Occasion::kHdr},
    {"poses", Occasion::kPoses},
    {"footprint", Occasion::kFootprint},
};

constexpr double kPlate = 1.0;            // half width of the plate before nothing but sky
constexpr double kStops = 1.0;            // by which exposures differ from their mean, at most
constexpr double kWhiteBalance = 0.15;    // and channels, a part of their light
constexpr double kPassingDistance = 2.0;  // before the camera, scene units, where it sees
constexpr double kHalfWidth = 0.77;       // this far to both sides, a little rounded down
constexpr double kAside = 0.154;          // by which who passes by is not in the middle of his part
constexpr double kUpDown = 0.385;         // of the middle of the photograph, at most
constexpr double kPassersRadius = 0.268;  // of a ball as large as all that pass by together
constexpr int kEveryToJudgeBy = 8;
const Color kGloss = Color::Constant(0.8);
constexpr double kGlossExponent = 6;  // half as bright 27 degrees off
constexpr double kFarFactor = 4;      // of the distance of cameras, and

// The i-th random number of a view, in [-1, 1).
double Signed(int i, int view, unsigned seed) {
  return 2 * UnitFromHash(Hash(view, i, 7, seed)) - 1;
}

// Clothes are of colours that nothing else there has.
double DarkOrBright(double random) { return random < 0 ? 0.03 : 0.9; }

// Two or three balls, each of one colour, beside each other on two thirds of the way to what the
// camera looks at, where other cameras look, too. Together they hide a twelfth of the photograph.
std::vector<Object> PassersBy(int view, unsigned seed, const Eigen::Isometry3d& world_from_camera) {
  const int count = 2 + static_cast<int>(Hash(view, 8, 7, seed) % 2);
  std::vector<Object> balls(count);
  for (int k = 0; k < count; ++k) {
    const auto random = [&](int i) { return Signed(16 * (k + 1) + i, view, seed); };
    const double left_to_right = (2 * k + 1.0) / count - 1;  // the middle of its part
    const Vector3d in_camera(kHalfWidth * left_to_right + kAside * random(0), kUpDown * random(1),
                             kPassingDistance);
    balls[k].shape = Sphere{world_from_camera * in_camera, kPassersRadius / std::sqrt(count)};
    balls[k].material.albedo =
        Plain{Color(random(2), random(3), random(4)).unaryExpr(&DarkOrBright)};
  }
  return balls;
}

bool IsGround(const Object& object) { return std::holds_alternative<Disc>(object.shape); }

bool IsCutOut(Occasion occasion) {
  return occasion == Occasion::kAlpha || occasion == Occasion::kFootprint;
}

}  // namespace

Occasion OccasionFromName(const std::string& name) {
  const auto found = std::ranges::find(kNames, name, &std::pair<std::string, Occasion>::first);
  if (found != kNames.end()) return found->second;
  throw InputError("--calls-for {}: choose one of {}", name, OccasionNames());
}

std::string OccasionNames() {
  std::string names;
  for (const auto& [name, occasion] : kNames) names += (names.empty() ? "" : ", ") + name;
  return names;
}

int UsualViews(Occasion occasion) {
  // Of nine on a ring the two to judge by would be neighbours, and look where no other does.
  if (occasion == Occasion::kDepth) return 10;
  return occasion == Occasion::kFootprint ? 64 : 36;
}

Scene SceneOf(Occasion occasion) {
  Scene scene = BuiltInScene();
  if (IsCutOut(occasion)) {
    scene.objects.erase(scene.objects.begin());  // the slab
    std::erase_if(scene.objects, IsGround);
    scene.dome.reset();
  }
  // As far as the eye can tell, without end.
  if (occasion == Occasion::kBackground || occasion == Occasion::kUnbounded) {
    scene.dome->radius = 1000;
  }
  if (occasion == Occasion::kBackground) {
    std::get<Box>(scene.objects.front().shape).half_size.head<2>().setConstant(kPlate);
    std::erase_if(scene.objects, IsGround);
  }
  if (occasion == Occasion::kUnbounded) {
    std::get<Disc>(std::ranges::find_if(scene.objects, IsGround)->shape).radius = 300;
  }
  for (Object& object : scene.objects) {
    if (occasion == Occasion::kBuiltIn) break;
    object.material.mirror = Color::Zero();
    // On what stands there. The slab is in every photograph and all of it faces the same way, so
    // that its gloss would look like a change of exposure.
    const bool slab = &object == &scene.objects.front();
    if (occasion == Occasion::kView && !slab && !std::holds_alternative<Disc>(object.shape)) {
      object.material.gloss = kGloss;
      object.material.highlight_exponent = kGlossExponent;
    }
  }
  if (occasion == Occasion::kHdr) scene.sun.irradiance *= 8;
  return scene;
}

bool IsToJudgeBy(int view) { return view % kEveryToJudgeBy == 0; }

double DistanceFactor(Occasion occasion, int view) {
  if (occasion != Occasion::kFootprint) return 1;
  // In turn, and so that those to judge by are in turn, too.
  return (view + view / kEveryToJudgeBy) % 2 == 0 ? 1 : kFarFactor;
}

Photography PhotographyOf(Occasion occasion, int view, unsigned seed,
                          const Eigen::Isometry3d& world_from_camera) {
  Photography photography;
  photography.linear = occasion == Occasion::kHdr;
  photography.alpha = IsCutOut(occasion);
  photography.mask = occasion == Occasion::kMasks;
  if (occasion == Occasion::kExposure) {
    photography.gain.setConstant(std::exp2(kStops * Signed(4, view, seed)));
    for (int c = 0; c < 3; ++c) {
      photography.gain[c] *= 1 + kWhiteBalance * Signed(5 + c, view, seed);
    }
  }
  const bool passes = occasion == Occasion::kMasks || occasion == Occasion::kRobust;
  if (passes && !IsToJudgeBy(view)) {
    photography.passers_by = PassersBy(view, seed, world_from_camera);
  }
  return photography;
}

}  // namespace nerf::synthetic
