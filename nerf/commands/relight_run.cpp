#include "nerf/commands/relight_run.h"

#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/interrupt.h"
#include "nerf/base/progress.h"
#include "nerf/base/stopwatch.h"
#include "nerf/commands/environment_option.h"
#include "nerf/commands/relit_pictures.h"
#include "nerf/image/image_io.h"
#include "nerf/light/light_plan.h"
#include "nerf/model/materials_file.h"
#include "nerf/model/run_folder.h"
#include "nerf/output/video.h"
#include "nerf/pipeline/photograph_lights.h"
#include "nerf/relight/environment_light.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

constexpr double kTurningFramesPerSecond = 24;

std::vector<PlannedLight> LightsOf(const RelightRunArguments& arguments) {
  std::vector<PlannedLight> lights;
  if (!arguments.lights.empty()) lights = ReadLightPlan(arguments.lights).lights;
  for (const std::string& name : arguments.environments) {
    PlannedLight light;
    light.name = fs::path(name).stem().string();
    light.environment = OpenEnvironment(name);
    lights.push_back(std::move(light));
  }
  for (PlannedLight& light : lights) {
    if (light.has_unknown_environment) {
      throw InputError("{}: the light {} has an unknown environment; give a map", arguments.lights,
                       light.name);
    }
    light.rotate += arguments.rotate;
    if (std::ranges::count(lights, light.name, &PlannedLight::name) > 1) {
      throw InputError("two lights are named {}, which names a folder; rename one", light.name);
    }
  }
  return lights;
}

// Shows the views of a run, one light after the other.
class Show {
 public:
  explicit Show(const RelightRunArguments& arguments)
      : arguments_(arguments),
        lights_(LightsOf(arguments)),
        run_(OpenRun(arguments.run)),
        scene_(run_.model->Scene()),
        materials_(WithEdits()),
        list_(ChooseShots(run_, arguments.shots, arguments.run)),
        relighter_(materials_.surface),
        stop_(StopOnInterrupt()) {
    if (arguments.turning_frames > 0) list_.shots.resize(1);
  }

  void Run() {
    const double prepared = watch_.Seconds();
    const std::size_t of_light = arguments_.turning_frames > 0
                                     ? static_cast<std::size_t>(arguments_.turning_frames)
                                     : list_.shots.size();
    progress_.emplace("relighting", static_cast<std::int64_t>(of_light * lights_.size()));
    for (const PlannedLight& light : lights_) {
      const fs::path folder = FolderOf(light);
      MakeOutputFolder(folder);
      if (arguments_.turning_frames > 0) {
        Turn(light, folder);
      } else {
        Views(light, folder);
      }
    }
    progress_.reset();
    fmt::print(
        "{} picture{}{}; {:.1f} s for shadows, {:.2f} s a picture\nPNG and linear EXR are in {}\n",
        done_, done_ == 1 ? "" : "s",
        lights_.size() == 1 ? fmt::format(" at {:+.2f} stops", stops_.value_or(0)) : "", prepared,
        (watch_.Seconds() - prepared) / static_cast<double>(done_),
        lights_.size() == 1 ? FolderOf(lights_[0]).string() : Root().string());
  }

 private:
  Materials WithEdits() const {
    Materials materials = ReadMaterials(MaterialsPath(arguments_.run));
    if (!arguments_.edit.empty()) {
      materials.surface.edits =
          ReadMaterialEdits(arguments_.edit, run_.model->Scene().normalized_from_world,
                            materials.surface.mesh.vertices);
    }
    return materials;
  }

  fs::path Root() const {
    return arguments_.output.empty() ? fs::path(arguments_.run) / "relit"
                                     : fs::path(arguments_.output);
  }
  fs::path FolderOf(const PlannedLight& light) const {
    const bool is_only = lights_.size() == 1 && !arguments_.output.empty();
    return is_only ? Root() : Root() / light.name;
  }

  RelitBackground BackgroundOf(const PlannedLight& light) const {
    if (!arguments_.shows_map || !light.environment) return {};
    return {&*light.environment, TurnedMap(scene_.normalized_from_world.rotation, light.rotate),
            static_cast<float>(std::exp2(light.exposure))};
  }

  void Shine(const PlannedLight& light) {
    relighter_.SetLight(
        LightInFrame(light, scene_.normalized_from_world, materials_.surface.Directions()),
        arguments_.bounces);
  }

  // One picture.
  void Write(const LookedAt& view, const PlannedLight& light, const fs::path& stem) {
    if (stop_) {
      progress_.reset();
      fmt::print("stopped; the finished pictures are in {}\n", stem.parent_path().string());
      throw CLI::RuntimeError(130);
    }
    const Image relit =
        RelitImage(view, relighter_.Reflect(view.seen), scene_, BackgroundOf(light));
    if (!stops_) stops_ = ExposureOf(relit);  // one for all pictures of a light
    WriteImage(stem.string() + ".exr", relit);
    WriteImage(stem.string() + ".png", Displayed(relit, *stops_, scene_.has_alpha));
    progress_->Update(++done_, stem.filename().string());
  }

  void Views(const PlannedLight& light, const fs::path& folder) {
    stops_ = arguments_.exposure;
    Shine(light);
    for (const Shot& shot : list_.shots) {
      Write(LookAt(run_, relighter_, shot), light, folder / shot.name);
    }
    if (list_.frames_per_second) {
      WriteFilm(folder, static_cast<int>(list_.shots.size()), *list_.frames_per_second);
    }
  }

  // The first view, while the light turns once about the vertical axis.
  void Turn(PlannedLight light, const fs::path& folder) {
    stops_ = arguments_.exposure;
    const LookedAt view = LookAt(run_, relighter_, list_.shots.front());
    const double begin = light.rotate;
    for (int frame = 0; frame < arguments_.turning_frames; ++frame) {
      light.rotate = begin + 360.0 * frame / arguments_.turning_frames;
      Shine(light);
      Write(view, light, folder / fs::path(FrameName(frame)).stem());
    }
    WriteFilm(folder, arguments_.turning_frames, kTurningFramesPerSecond);
  }

  void WriteFilm(const fs::path& folder, int frames, double frames_per_second) {
    if (FfmpegIsInstalled()) {
      WriteVideo(folder, frames, frames_per_second, folder / "film.mp4");
    } else {
      fmt::print("no film.mp4, which needs the program ffmpeg\n");
    }
  }

  const RelightRunArguments& arguments_;
  Stopwatch watch_;
  std::vector<PlannedLight> lights_;
  OpenedRun run_;
  const SceneFacts& scene_;
  Materials materials_;
  ShotList list_;
  Relighter relighter_;
  const std::atomic<bool>& stop_;
  std::optional<ProgressLine> progress_;
  std::optional<double> stops_;
  std::int64_t done_ = 0;
};

}  // namespace

bool IsRun(const std::string& path) { return fs::exists(CheckpointPath(path)); }

void RelightRun(const RelightRunArguments& arguments) { Show(arguments).Run(); }

}  // namespace nerf
