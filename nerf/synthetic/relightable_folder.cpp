#include "nerf/synthetic/relightable_folder.h"

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/progress.h"
#include "nerf/geometry/directions.h"
#include "nerf/image/image_io.h"
#include "nerf/output/camera_path.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/rigid_pose.h"
#include "nerf/synthetic/check_range.h"
#include "nerf/synthetic/relightable_scene.h"
#include "nerf/transport/pixel_rays.h"
#include "nerf/transport/scene_renderer.h"

namespace nerf::synthetic {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr char kRelightableMark[] = "relightable.txt";
constexpr char kRelightableText[] =
    "A capture of nerf sample --relightable: the next one here replaces it.\n";
constexpr const char* kFolders[] = {"train", "test", "gt", "environments"};
constexpr int kPoints = 16;  // in a pixel
constexpr int kMapHeight = 64;
constexpr double kCameraDistance = 3.2, kFieldOfView = 40;  // scene units, degrees
const Vector3d kCentre(0, 0, 0.22);

std::string NameOf(int view) { return fmt::format("view_{:03d}", view); }

// Over the upper hemisphere and a little below its horizon, evenly; none from straight above.
Eigen::Isometry3d PoseOf(int view, int views, double turn) {
  const double z = -0.1 + 1.02 * (view + 0.5) / views;
  const double around = turn + view * 2.399963229728653;  // the golden angle
  const double radius = std::sqrt(1 - z * z);
  return LookAt(
      kCentre + kCameraDistance * Vector3d(radius * std::cos(around), radius * std::sin(around), z),
      kCentre, Vector3d::UnitZ());
}

class Writer {
 public:
  Writer(const fs::path& folder, const RelightableOptions& options,
         const std::function<bool()>& keep_on)
      : folder_(folder),
        options_(options),
        keep_on_(keep_on),
        lights_(BuiltInLights()),
        truth_(MakeRelightableScene()),
        camera_(PinholeFromFov(
            options.width, options.height,
            2 * std::atan(std::tan(kFieldOfView * std::numbers::pi / 360) * options.height /
                          std::max(options.width, options.height)))),
        progress_("rendering",
                  options.views + options.test_views * static_cast<int>(lights_.size())) {}

  bool Write() {
    nlohmann::json lights;
    for (const BuiltInLight& light : lights_) {
      maps_.push_back(std::make_shared<EnvironmentMap>(MapInWorld(light, kMapHeight)));
      const std::string file = light.name + ".exr";
      WriteImage(folder_ / "environments" / file, MapInFile(light, kMapHeight));
      lights[light.name] = {{"file", file}, {"png_exposure", kExposure}};
    }
    nlohmann::json train = Header(), test = Header();
    train["lights"] = test["lights"] = lights;
    for (int view = 0; view < options_.views; ++view) {
      const auto light = static_cast<std::size_t>(view % options_.lights);
      const Eigen::Isometry3d pose = PoseOf(view, options_.views, 0);
      if (!Photograph(pose, light, folder_ / "train" / (NameOf(view) + ".png"))) return false;
      train["frames"].push_back(Frame("train/" + NameOf(view), pose, light));
    }
    for (int view = 0; view < options_.test_views; ++view) {
      const Eigen::Isometry3d pose = PoseOf(view, options_.test_views, 1);
      nlohmann::json frame = Frame("test/" + NameOf(view), pose, 0);
      frame["gt"] = "gt/" + NameOf(view);
      WriteTruth(pose, NameOf(view));
      for (std::size_t light = 0; light < lights_.size(); ++light) {
        std::string name = NameOf(view);
        if (light > 0) {
          name += "_" + lights_[light].name;
          frame["relit"][lights_[light].name] = "test/" + name;
        }
        if (!Photograph(pose, light, folder_ / "test" / (name + ".png"))) return false;
      }
      test["frames"].push_back(frame);
    }
    WriteFileAtomically(folder_ / "transforms_test.json", test.dump(1) + "\n");
    WriteFileAtomically(folder_ / "transforms_train.json", train.dump(1) + "\n");
    return true;
  }

 private:
  static constexpr double kExposure = 0.6;

  nlohmann::json Header() const {
    return {{"w", camera_.width},
            {"h", camera_.height},
            {"fl_x", camera_.params[0]},
            {"fl_y", camera_.params[1]},
            {"cx", camera_.params[2]},
            {"cy", camera_.params[3]},
            {"frames", nlohmann::json::array()}};
  }

  nlohmann::json Frame(const std::string& path, const Eigen::Isometry3d& pose,
                       std::size_t light) const {
    const Eigen::Matrix4d matrix = WorldFromOpenGLCamera(pose).matrix();
    nlohmann::json rows = nlohmann::json::array();
    for (int r = 0; r < 4; ++r) {
      rows.push_back({matrix(r, 0), matrix(r, 1), matrix(r, 2), matrix(r, 3)});
    }
    return {{"file_path", path}, {"light", lights_[light].name}, {"transform_matrix", rows}};
  }

  // The hits at the points of a pixel at which its photograph is rendered.
  template <class Add>
  void ForEachHit(const Eigen::Isometry3d& pose, int x, int y, const Add& add) const {
    for (int i = 0; i < kPoints; ++i) {
      const Ray ray = RayThroughPixel(camera_, pose, Eigen::Vector2d(x, y) + PositionInPixel(i));
      if (const auto hit = FirstHit(truth_.scene.surfaces, ray)) add(*hit);
    }
  }

  // False where it was stopped.
  bool Photograph(const Eigen::Isometry3d& pose, std::size_t light, const fs::path& file) {
    if (!keep_on_()) return false;
    truth_.scene.environment = maps_[light];
    TransportTerms terms;
    terms.emission = false;  // the background is transparent
    terms.bounces = options_.bounces;
    RenderSettings settings;
    settings.positions = kPoints;
    settings.paths_per_position = std::max(1, options_.paths / kPoints);
    settings.seed = static_cast<std::uint64_t>(done_);
    const SceneRendering rendering = RenderScene(truth_.scene, terms, camera_, pose, settings);
    Image photo(camera_.width, camera_.height, 4, ColorEncoding::kLinear);
    for (int y = 0; y < camera_.height; ++y) {
      for (int x = 0; x < camera_.width; ++x) {
        double covered = 0;
        ForEachHit(pose, x, y, [&](const SurfaceHit&) { ++covered; });
        const double alpha = covered / kPoints;
        if (alpha == 0) continue;
        for (int c = 0; c < 3; ++c) {
          photo.At(x, y)[c] = static_cast<float>(
              kExposure * static_cast<double>(rendering.color.At(x, y)[c]) / alpha);
        }
        photo.At(x, y)[kAlphaChannel] = static_cast<float>(alpha);
      }
    }
    WriteImage(file, photo);
    progress_.Update(++done_, file.filename().string());
    return true;
  }

  void WriteTruth(const Eigen::Isometry3d& pose, const std::string& name) const {
    const int width = camera_.width, height = camera_.height;
    Image albedo(width, height, 4, ColorEncoding::kLinear);
    Image normal(width, height, 3, ColorEncoding::kLinear);
    Image material(width, height, 3, ColorEncoding::kLinear);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        Color sum = Color::Zero();
        double count = 0;
        ForEachHit(pose, x, y, [&](const SurfaceHit& hit) {
          const TrueMaterial& own = truth_.MaterialAt(hit);
          sum += own.base_color * (1 - own.metallic);
          ++count;
        });
        if (count > 0) {
          for (int c = 0; c < 3; ++c) albedo.At(x, y)[c] = static_cast<float>(sum[c] / count);
          albedo.At(x, y)[kAlphaChannel] = static_cast<float>(count / kPoints);
        }
        const auto centre =
            FirstHit(truth_.scene.surfaces, RayThroughPixel(camera_, pose, {x + 0.5, y + 0.5}));
        if (!centre) continue;
        for (int c = 0; c < 3; ++c) {
          normal.At(x, y)[c] = static_cast<float>(centre->normal_in_world[c]);
        }
        material.At(x, y)[0] = static_cast<float>(truth_.MaterialAt(*centre).roughness);
        material.At(x, y)[1] = static_cast<float>(truth_.MaterialAt(*centre).metallic);
      }
    }
    WriteImage(folder_ / "gt" / (name + "_albedo.exr"), albedo);
    WriteImage(folder_ / "gt" / (name + "_normal.exr"), normal);
    WriteImage(folder_ / "gt" / (name + "_material.exr"), material);
  }

  const fs::path& folder_;
  const RelightableOptions& options_;
  const std::function<bool()>& keep_on_;
  std::vector<BuiltInLight> lights_;
  std::vector<std::shared_ptr<const EnvironmentMap>> maps_;
  RelightableScene truth_;
  Camera camera_;
  ProgressLine progress_;
  int done_ = 0;
};

}  // namespace

void RelightableOptions::Check() const {
  CheckRange("--views", views, 2, 1000);
  CheckRange("--width", width, 1, 8192);
  CheckRange("--height", height, 1, 8192);
  CheckRange("--samples", paths, 4, 1'000'000);
  CheckRange("--relightable", lights, 1, 3);
  CheckRange("--bounces", bounces, 0, 100);
}

bool WriteRelightable(const fs::path& folder, const RelightableOptions& options,
                      const std::function<bool()>& keep_on) {
  options.Check();
  if (fs::exists(folder) && !fs::exists(folder / kRelightableMark) &&
      !(fs::is_directory(folder) && fs::is_empty(folder))) {
    throw InputError("{} exists, but is not a relightable capture: choose an empty or a new folder",
                     folder.string());
  }
  MakeOutputFolder(folder);
  WriteFileAtomically(folder / kRelightableMark, kRelightableText);
  for (const char* name : {"transforms_train.json", "transforms_test.json"}) {
    RemoveAll(folder / name);
  }
  for (const char* part : kFolders) {
    RemoveAll(folder / part);
    MakeOutputFolder(folder / part);
  }
  return Writer(folder, options, keep_on).Write();
}

}  // namespace nerf::synthetic
