#include "nerf/synthetic/scenario.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nerf/base/input_error.h"
#include "nerf/synthetic/hash.h"

namespace nerf::synthetic {
namespace {

using Eigen::Vector3d;

struct ScenarioName {
  const char* name;
  Scenario scenario;
  const char* former_name = nullptr;
};
constexpr ScenarioName kNames[] = {
    {"built-in", Scenario::kBuiltIn},
    {"nothing", Scenario::kNothing},
    {"view_dependence", Scenario::kViewDependence, "view"},
    {"background", Scenario::kBackground},
    {"unbounded", Scenario::kUnbounded},
    {"exposure", Scenario::kExposure},
    {"masks", Scenario::kMasks},
    {"alpha", Scenario::kAlpha},
    {"robust", Scenario::kRobust},
    {"depth_supervision", Scenario::kDepthSupervision, "depth"},
    {"hdr", Scenario::kHdr},
    {"pose_refinement", Scenario::kPoseRefinement, "poses"},
    {"anti_aliasing", Scenario::kAntiAliasing, "footprint"},
    {"textureless", Scenario::kTextureless},
    {"repeated", Scenario::kRepeated},
    {"mirrors", Scenario::kMirrors},
    {"two_groups", Scenario::kTwoGroups},
    {"motion_blur", Scenario::kMotionBlur},
};

constexpr double kInfinity = 1000;  // radius of a dome that no camera can tell from infinity
constexpr double kHorizon = 300;    // radius of a ground that reaches the horizon
constexpr double kPlate = 1.0;      // half width of the plate of kBackground

constexpr double kStops = 1.0;          // largest deviation of an exposure from the mean
constexpr double kWhiteBalance = 0.15;  // largest relative deviation of a channel

// Passers-by: their distance before the camera, and the half width that it sees there, rounded
// down; scene units.
constexpr double kPassingDistance = 2.0;
constexpr double kHalfWidth = 0.77;
constexpr double kSideways = 0.154;       // largest offset of each from the centre of its part
constexpr double kUpDown = 0.385;         // largest offset from the centre of the photograph
constexpr double kPassersRadius = 0.268;  // of a ball with the area of all passers-by together

const Color kGloss = Color::Constant(0.8);
constexpr double kGlossExponent = 6;  // half as bright 27 degrees off

constexpr int kHeldOutEvery = 8;
constexpr double kFarFactor = 4;         // of the distance of the far cameras of kAntiAliasing
constexpr double kMirror = 0.85;         // reflectance of everything in kMirrors
constexpr double kGroup = 0.2;           // of a ring, each of the two groups of kTwoGroups
constexpr int kBlurredEvery = 3;         // in kMotionBlur
constexpr double kTurnWhileOpen = 0.02;  // radians, in kMotionBlur
constexpr double kHdrSun = 8;            // factor of the sun's irradiance in kHdr

// The i-th random number of a view, in [-1, 1).
double Signed(int i, int view, unsigned seed) {
  return 2 * UnitFromHash(Hash(view, i, 7, seed)) - 1;
}

// Channels of passers-by are dark or bright, unlike the rest of the scene.
double DarkOrBright(double random) { return random < 0 ? 0.03 : 0.9; }

// Two or three balls of one colour each, side by side at two thirds of the distance to the subject,
// where other cameras look as well. Together they hide a twelfth of the photograph.
std::vector<Object> PassersBy(int view, unsigned seed, const Eigen::Isometry3d& world_from_camera) {
  const int count = 2 + static_cast<int>(Hash(view, 8, 7, seed) % 2);
  std::vector<Object> balls(count);
  for (int k = 0; k < count; ++k) {
    const auto random = [&](int i) { return Signed(16 * (k + 1) + i, view, seed); };
    const double left_to_right = (2 * k + 1.0) / count - 1;  // the centre of its part
    const Vector3d in_camera(kHalfWidth * left_to_right + kSideways * random(0),
                             kUpDown * random(1), kPassingDistance);
    balls[k].shape = Sphere{world_from_camera * in_camera, kPassersRadius / std::sqrt(count)};
    balls[k].material.albedo =
        Plain{Color(random(2), random(3), random(4)).unaryExpr(&DarkOrBright)};
  }
  return balls;
}

bool IsGround(const Object& object) { return std::holds_alternative<Disc>(object.shape); }

bool IsCutOut(Scenario scenario) {
  return scenario == Scenario::kAlpha || scenario == Scenario::kAntiAliasing;
}

// Hardly any texture: marble of one colour in broad, faint clouds.
Texture Faded(const Texture& texture) {
  constexpr double kContrast = 0.06;
  const Color color = Evaluate(texture, Vector3d(0.31, 0.17, 0.11));
  Marble marble{.ramp = {}, .frequency = 1.5, .octaves = 1, .seed = 71};
  for (int i = 0; i < 4; ++i) marble.ramp[i] = color * (1 + kContrast * (i / 3.0 - 0.5));
  return marble;
}

// A pattern of two by two cells, everywhere the same.
Texture Repeated() {
  return Mosaic{.palette = {ColorFromSrgbHex(0xd5553a), ColorFromSrgbHex(0xf0b14a),
                            ColorFromSrgbHex(0xf3e3c3), ColorFromSrgbHex(0x8c2f39)},
                .mortar = ColorFromSrgbHex(0x3a2c2a),
                .tile = 0.12,
                .period = 2,
                .seed = 37};
}

// Changes surfaces for the scenarios that are hard for structure from motion.
void MakeHard(Scenario scenario, Scene& scene) {
  for (Object& object : scene.objects) {
    if (scenario == Scenario::kTextureless) object.material.albedo = Faded(object.material.albedo);
    if (scenario == Scenario::kRepeated) object.material.albedo = Repeated();
    if (scenario == Scenario::kMirrors) object.material.mirror.setConstant(kMirror);
  }
  if (scenario == Scenario::kTextureless || scenario == Scenario::kRepeated) {
    scene.dome->radiance = Plain{ColorFromSrgbHex(0xb9d6ea)};
  }
}

}  // namespace

Scenario ScenarioFromName(const std::string& name) {
  for (const ScenarioName& known : kNames) {
    if (name == known.name) return known.scenario;
    if (known.former_name != nullptr && name == known.former_name) return known.scenario;
  }
  throw InputError("--scenario {}: choose one of {}", name, ScenarioNames());
}

std::string ScenarioNames() {
  std::string names;
  for (const ScenarioName& known : kNames) {
    names += names.empty() ? "" : ", ";
    names += known.name;
  }
  return names;
}

int DefaultViewCount(Scenario scenario) {
  // Of nine views on a ring the two held-out ones would be neighbours, and would see what no
  // training view sees.
  if (scenario == Scenario::kDepthSupervision) return 10;
  return scenario == Scenario::kAntiAliasing ? 64 : 36;
}

Scene SceneFor(Scenario scenario) {
  Scene scene = BuiltInScene();
  if (scenario == Scenario::kBuiltIn) return scene;
  if (IsCutOut(scenario)) {
    scene.objects.erase(scene.objects.begin());  // the slab
    std::erase_if(scene.objects, IsGround);
    scene.dome.reset();
  }
  if (scenario == Scenario::kBackground || scenario == Scenario::kUnbounded) {
    scene.dome->radius = kInfinity;
  }
  if (scenario == Scenario::kBackground) {
    std::get<Box>(scene.objects.front().shape).half_size.head<2>().setConstant(kPlate);
    std::erase_if(scene.objects, IsGround);
  }
  if (scenario == Scenario::kUnbounded) {
    std::get<Disc>(std::ranges::find_if(scene.objects, IsGround)->shape).radius = kHorizon;
  }
  for (Object& object : scene.objects) {
    object.material.mirror = Color::Zero();
    // The slab stays diffuse: it is in every photograph, and as all of it faces the same way, its
    // gloss would look like a change of exposure.
    const bool slab = &object == &scene.objects.front();
    if (scenario == Scenario::kViewDependence && !slab && !IsGround(object)) {
      object.material.gloss = kGloss;
      object.material.highlight_exponent = kGlossExponent;
    }
  }
  if (scenario == Scenario::kHdr) scene.sun.irradiance *= kHdrSun;
  MakeHard(scenario, scene);
  return scene;
}

bool IsHeldOut(int view) { return view % kHeldOutEvery == 0; }

double DistanceFactor(Scenario scenario, int view) {
  if (scenario != Scenario::kAntiAliasing) return 1;
  // Near and far alternate, among the held-out views as well.
  return (view + view / kHeldOutEvery) % 2 == 0 ? 1 : kFarFactor;
}

double AzimuthIn(Scenario scenario, double azimuth) {
  if (scenario != Scenario::kTwoGroups) return azimuth;
  const double turns = azimuth / (2 * std::numbers::pi);
  const double half = 2 * (turns - std::floor(turns));  // 0 to 1 in one group, 1 to 2 in the other
  const double side = std::floor(half);
  return 2 * std::numbers::pi * (side / 2 + kGroup * (half - side));
}

PhotoSettings PhotoSettingsFor(Scenario scenario, int view, unsigned seed,
                               const Eigen::Isometry3d& world_from_camera) {
  PhotoSettings settings;
  settings.linear = scenario == Scenario::kHdr;
  settings.alpha = IsCutOut(scenario);
  settings.mask = scenario == Scenario::kMasks;
  if (scenario == Scenario::kExposure) {
    settings.gain.setConstant(std::exp2(kStops * Signed(4, view, seed)));
    for (int c = 0; c < 3; ++c) {
      settings.gain[c] *= 1 + kWhiteBalance * Signed(5 + c, view, seed);
    }
  }
  if (scenario == Scenario::kMotionBlur && view % kBlurredEvery == kBlurredEvery - 1) {
    settings.turn =
        kTurnWhileOpen * Vector3d(Signed(9, view, seed), Signed(10, view, seed), 0).normalized();
  }
  const bool has_passers_by = scenario == Scenario::kMasks || scenario == Scenario::kRobust;
  if (has_passers_by && !IsHeldOut(view)) {
    settings.passers_by = PassersBy(view, seed, world_from_camera);
  }
  return settings;
}

}  // namespace nerf::synthetic
