#include "nerf/synthetic/light_stage.h"

#include <bit>
#include <cstdint>
#include <numbers>
#include <regex>
#include <utility>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/progress.h"
#include "nerf/geometry/directions.h"
#include "nerf/image/image_files.h"
#include "nerf/image/image_io.h"
#include "nerf/light/light_file.h"
#include "nerf/material/coated_diffuse.h"
#include "nerf/material/lambert.h"
#include "nerf/material/merl.h"
#include "nerf/output/camera_path.h"
#include "nerf/scene/camera.h"
#include "nerf/synthetic/check_range.h"

namespace nerf::synthetic {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr double kRadius = 0.33;  // of a ball, scene units
constexpr double kMillimetersAcross =
    12;                                // of the marble ball: small, so that light passes through
constexpr int kPositions = 4;          // in a pixel
constexpr int kPathsWithBounces = 16;  // in each place, under one light

// A file that marks a folder as a light-stage capture that may be replaced.
constexpr const char* kMark = "light_stage.txt";
constexpr const char* kMarkText =
    "A capture of nerf sample --light-stage: the next one here replaces its images and lights.\n";

Surface Ball(double x, std::shared_ptr<const Brdf> brdf) {
  return {Sphere{{x, kRadius, 0}, kRadius}, std::move(brdf)};
}

Surface MarbleBall(double x) {
  const Sphere sphere{{x, kRadius, 0}, kRadius};
  const Medium marble = InUnits(MarbleMedium(), 2 * kRadius / kMillimetersAcross);
  Surface ball{sphere, nullptr};
  ball.subsurface = std::make_shared<SubsurfaceSphere>(sphere, marble);
  return ball;
}

std::string ImageName(int light) { return fmt::format("light_{:04d}.exr", light); }

// Protects folders with files that are not from here: throws unless the folder is new, empty, or an
// earlier capture. WriteLightStage writes the mark first, so that an interrupted capture is
// recognized, too.
void CheckIsLightStage(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) {
    throw InputError("{} is a file: choose an empty or a new folder", folder.string());
  }
  if (!fs::exists(folder / kMark) && !fs::is_empty(folder)) {
    throw InputError(
        "{} contains {}, but is not a light-stage capture: choose an empty or a new folder",
        folder.string(), fs::directory_iterator(folder)->path().filename().string());
  }
  static const std::regex image_name(R"(light_\d{4}\.exr)");
  for (const fs::path& file : ImageFilesIn(folder)) {
    if (std::regex_match(file.filename().string(), image_name)) continue;
    throw InputError("{} is not part of a light-stage capture: choose an empty or a new folder",
                     file.string());
  }
}

}  // namespace

void LightStageOptions::Check() const {
  CheckRange("--light-stage", lights, 3, 10'000);
  CheckRange("--width", width, 1, 8192);
  CheckRange("--height", height, 1, 8192);
  CheckRange("--paths", paths, 1, 1'000'000);
  terms.Check();
}

SurfaceScene LightStageSubject(std::shared_ptr<const Brdf> third_ball) {
  if (!third_ball) {
    third_ball = std::make_shared<Conductor>(Color(1.00, 0.77, 0.34), 0.25);
  }
  SurfaceScene scene;
  scene.surfaces = {
      {Box{{0, -0.05, 0}, {1.9, 0.05, 0.9}}, std::make_shared<Lambert>(Color(0.42, 0.36, 0.30))},
      Ball(-1.12, std::make_shared<Lambert>(Color(0.30, 0.52, 0.42))),
      Ball(-0.37, std::make_shared<CoatedDiffuse>(Color(0.55, 0.06, 0.05), 1.5, 0.2)),
      Ball(0.37, std::move(third_ball)),
      MarbleBall(1.12)};
  return scene;
}

StageCamera LightStageCamera(int width, int height) {
  // The horizontal angle is the same for every aspect ratio.
  const double half_width = std::tan(18.0 / 180 * std::numbers::pi);
  const double vertical_fov = 2 * std::atan(half_width * height / width);
  return {PinholeFromFov(width, height, vertical_fov),
          LookAt({0, 1.3, 4.6}, {0, 0.28, 0}, Vector3d::UnitY())};
}

std::vector<DirectionalLight> LightStageLights(int count) {
  std::vector<DirectionalLight> lights;
  for (int i = 0; i < count; ++i) {
    const Vector3d d = FibonacciDirection(i, count);
    lights.push_back({Vector3d(d.x(), d.z(), -d.y())});  // the axis of the lattice is y
  }
  return lights;
}

Image RenderUnder(SurfaceScene& subject, const DirectionalLight& light, const StageCamera& camera,
                  const TransportTerms& terms) {
  subject.directional_lights = {light};
  subject.environment = nullptr;
  RenderSettings settings;
  settings.positions = kPositions;
  settings.paths_per_position = terms.bounces > 0 ? kPathsWithBounces : 1;
  // A different seed for each light, so that the noise of the bounces averages out.
  settings.seed = Mix64(std::bit_cast<std::uint64_t>(light.to_light.y()));
  return RenderScene(subject, terms, camera.camera, camera.world_from_camera, settings).color;
}

SceneRendering RenderUnder(SurfaceScene& subject, std::shared_ptr<const EnvironmentMap> environment,
                           const StageCamera& camera, int paths, const TransportTerms& terms,
                           const std::function<bool()>& keep_on) {
  subject.directional_lights.clear();
  subject.environment = std::move(environment);
  RenderSettings settings;
  settings.positions = kPositions;
  settings.paths_per_position = paths;
  return RenderScene(subject, terms, camera.camera, camera.world_from_camera, settings, "direct",
                     keep_on);
}

bool WriteLightStage(const fs::path& folder, const LightStageOptions& options,
                     const std::function<bool()>& keep_on) {
  options.Check();
  std::shared_ptr<const EnvironmentMap> environment;
  if (!options.environment.empty()) {
    environment = std::make_shared<EnvironmentMap>(EnvironmentMap::Read(options.environment));
  }
  std::shared_ptr<const Brdf> measured;
  if (!options.merl.empty()) measured = std::make_shared<MerlBrdf>(MerlBrdf::Read(options.merl));
  CheckIsLightStage(folder);
  MakeOutputFolder(folder);
  WriteFileAtomically(folder / kMark, kMarkText);
  RemoveAll(folder / "lights.txt");
  RemoveAll(folder / "truth" / "direct.exr");
  for (const fs::path& file : ImageFilesIn(folder)) RemoveAll(file);
  const std::vector<DirectionalLight> lights = LightStageLights(options.lights);
  const StageCamera camera = LightStageCamera(options.width, options.height);
  SurfaceScene subject = LightStageSubject(measured);
  if (environment) {
    MakeOutputFolder(folder / "truth");
    const SceneRendering direct =
        RenderUnder(subject, environment, camera, options.paths, options.terms, keep_on);
    if (!direct.finished) return false;
    WriteImage(folder / "truth" / "direct.exr", direct.color);
  }
  ProgressLine progress("rendering", options.lights);
  for (int i = 0; i < options.lights; ++i) {
    if (!keep_on()) return false;
    progress.Update(i, ImageName(i));
    WriteImage(folder / ImageName(i),
               RenderUnder(subject, lights[static_cast<std::size_t>(i)], camera, options.terms));
  }
  WriteLights(folder / "lights.txt", lights);
  return true;
}

}  // namespace nerf::synthetic
