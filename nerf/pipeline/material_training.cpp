#include "nerf/pipeline/material_training.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/base/progress.h"
#include "nerf/base/stopwatch.h"
#include "nerf/image/image_io.h"
#include "nerf/model/materials_file.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/light_effects.h"
#include "nerf/pipeline/material_fitting.h"
#include "nerf/relight/environment_light.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

constexpr int kFinerThanSurface = 2;  // the material field, than the cells of the surface
constexpr int kEnvironmentHeight = 32;
constexpr double kFileSeconds = 1;  // for the files
constexpr double kLeastFitSeconds = 1;
constexpr double kLeastToTry = 40;  // seconds, in which a trial takes a fraction

Eigen::AlignedBox3d BoxOf(const ScalarGrid& grid) {
  return {grid.origin, grid.PositionOf(grid.size.x() - 1, grid.size.y() - 1, grid.size.z() - 1)};
}

class MaterialTraining {
 public:
  MaterialTraining(const ModelSnapshot& field, const PosedImages& posed, const Dataset& data,
                   const MaterialPlan& plan, const std::atomic<bool>& stop,
                   const PipelineListener& listener)
      : field_(field),
        data_(data),
        plan_(plan),
        stop_(stop),
        listener_(listener),
        frame_(field.Scene().normalized_from_world),
        seed_(field.GetConfig().train.seed),
        posed_(posed) {}

  std::optional<MaterialsFound> Run() {
    std::optional<InterruptedMaterials> interrupted;
    const fs::path file = MaterialsPath(plan_.run);
    if (plan_.resume && fs::exists(file) && ReadMaterials(file).field_step == field_.Step()) {
      interrupted = ReadInterruptedMaterials(file);
      found_ = ReadMaterials(file);
      if (!interrupted) return Result(true);
    }
    lights_ = interrupted ? LightsBefore(*interrupted)
                          : LightsOn(posed_, plan_.lights, frame_, plan_.options.directions);
    LitSurface lit;
    if (interrupted) {
      lit = Relit();
    } else if (std::optional<LitSurface> begun = Begin()) {
      lit = std::move(*begun);
    } else {
      return std::nullopt;
    }
    if (!interrupted) WarnOfShortFit();
    MaterialFit fit(lit, found_.surface.field, found_.options, seed_);
    if (interrupted) fit.LoadFrom(interrupted->state, found_.steps);
    MaterialFitting fitting(fit, interrupted ? interrupted->planned_steps : plan_.options.steps,
                            interrupted ? interrupted->planned_seconds : SecondsOfFit(),
                            found_.seconds);
    const auto save = [&] { Save(fit, fitting, false); };
    const bool finished = fitting.Run(plan_.checkpoint_every, save, stop_, listener_);
    Save(fit, fitting, finished);
    psnr_ = fitting.Psnr();
    return Result(finished);
  }

 private:
  MaterialsFound Result(bool finished) const {
    const RelightableSurface& surface = found_.surface;
    const bool is_relative = std::ranges::any_of(
        lights_.groups, [](const LightGroup& light) { return !light.IsKnown(); });
    return {finished,
            found_.steps,
            psnr_,
            found_.seconds,
            surface.mesh.vertices.size(),
            surface.lights.size(),
            is_relative,
            plan_.run};
  }

  // Those of the fit that was interrupted, as they were planned.
  PhotographLights LightsBefore(const InterruptedMaterials& interrupted) const {
    PhotographLights lights{found_.surface.lights, interrupted.light_of};
    for (std::size_t g = 0; g < lights.groups.size(); ++g) {
      if (!interrupted.is_known[g]) lights.groups[g].environment = torch::Tensor();
    }
    return lights;
  }

  double SecondsOfFit() const {
    if (plan_.seconds == 0) return 0;
    return std::max(kLeastFitSeconds, plan_.seconds - kFileSeconds - watch_.Seconds());
  }

  void WarnOfShortFit() const {
    constexpr double kLeastShare = 0.2;
    if (plan_.seconds == 0 || SecondsOfFit() >= kLeastShare * plan_.seconds) return;
    listener_(Warning{fmt::format(
        "finding the surface took {} of {} for materials, so that they are hardly fitted; give "
        "them "
        "a longer time budget or a larger materials.share, or set materials.surface_resolution=80",
        FormatSeconds(watch_.Seconds()), FormatSeconds(plan_.seconds))});
  }

  // The surface, the effects, and an empty material field; nullopt where it was stopped.
  std::optional<LitSurface> Begin() {
    std::optional<ExtractedSurface> surface = SurfaceFoundBefore();
    if (!surface) surface = SurfaceOf(field_, data_, plan_.options, stop_, listener_);
    if (!surface) return std::nullopt;
    const MeshRays rays(surface->mesh);
    LitSurface lit =
        Observe(field_.GetModel(), data_, *surface, rays, lights_, plan_.options.directions);
    found_.options = plan_.options;
    found_.resolution = kFinerThanSurface * plan_.options.surface_resolution;
    found_.field_step = field_.Step();
    const Eigen::AlignedBox3d box = BoxOf(surface->distance);
    const bool has_time = plan_.seconds == 0 || plan_.seconds - watch_.Seconds() > kLeastToTry;
    const LightEffects effects = DecideLightEffects(plan_.options, *surface, rays, box,
                                                    found_.resolution, seed_, has_time, lit);
    listener_(LightEffectsDecided{effects.shadows, effects.bounces, effects.specular,
                                  effects.blocked, effects.specular_db});
    found_.surface.field =
        std::make_shared<MaterialField>(box, found_.resolution, !effects.specular, seed_);
    found_.surface.normal_offset = plan_.options.normal_offset;
    found_.surface.has_shadows = effects.shadows;
    found_.surface.has_bounces = effects.bounces;
    found_.surface.distance = std::move(surface->distance);
    found_.surface.mesh = std::move(surface->mesh);
    found_.surface.lights = lights_.groups;
    return lit;
  }

  // The surface of earlier materials of the same field is the same.
  std::optional<ExtractedSurface> SurfaceFoundBefore() const {
    if (!fs::exists(MaterialsPath(plan_.run))) return std::nullopt;
    try {
      Materials earlier = ReadMaterials(MaterialsPath(plan_.run));
      if (earlier.field_step != field_.Step() ||
          earlier.options.surface_resolution != plan_.options.surface_resolution) {
        return std::nullopt;
      }
      return ExtractedSurface{std::move(earlier.surface.distance), std::move(earlier.surface.mesh)};
    } catch (const InputError&) {  // damaged, or of another version
      return std::nullopt;
    }
  }

  // The same of a fit that was interrupted.
  LitSurface Relit() {
    const ExtractedSurface surface{found_.surface.distance, found_.surface.mesh};
    const MeshRays rays(surface.mesh);
    LitSurface lit =
        Observe(field_.GetModel(), data_, surface, rays, lights_, found_.options.directions);
    if (found_.surface.has_shadows) {
      AddShadows(surface, rays, found_.surface.has_bounces, lit);
    } else {
      RemoveShadows(lit);
    }
    return lit;
  }

  void Save(const MaterialFit& fit, const MaterialFitting& fitting, bool finished) {
    found_.steps = fit.Steps();
    found_.seconds = fitting.Seconds();
    const torch::Tensor environments = fit.Environments();
    for (std::size_t g = 0; g < found_.surface.lights.size(); ++g) {
      found_.surface.lights[g].environment = environments[static_cast<std::int64_t>(g)];
    }
    InterruptedMaterials interrupted;
    interrupted.planned_seconds = fitting.PlannedSeconds();
    interrupted.planned_steps = fitting.PlannedSteps();
    for (const LightGroup& light : lights_.groups) interrupted.is_known.push_back(light.IsKnown());
    interrupted.light_of = lights_.group_of;
    interrupted.photographs = plan_.photographs;
    fit.AddTo(interrupted.state);
    WriteMaterials(found_, MaterialsPath(plan_.run), finished ? nullptr : &interrupted);
    if (finished) WriteMaps(environments);
  }

  // Of each light that is not a dark room.
  void WriteMaps(const torch::Tensor& environments) const {
    for (std::size_t g = 0; g < found_.surface.lights.size(); ++g) {
      const torch::Tensor environment = environments[static_cast<std::int64_t>(g)];
      if (environment.abs().max().item<float>() == 0) continue;
      const bool is_only = found_.surface.lights.size() == 1;
      WriteImage(EnvironmentPath(plan_.run, is_only ? "" : LightName(g)),
                 EnvironmentImage(environment, kEnvironmentHeight, MapFromFrame(frame_.rotation)));
    }
  }
  std::string LightName(std::size_t g) const {
    const std::string& name = lights_.groups[g].name;
    return name.empty() || name.find('/') != std::string::npos ? std::to_string(g) : name;
  }

  const ModelSnapshot& field_;
  const Dataset& data_;
  const MaterialPlan& plan_;
  const std::atomic<bool>& stop_;
  const PipelineListener& listener_;
  const SceneNormalization& frame_;
  std::uint64_t seed_;
  const PosedImages& posed_;
  PhotographLights lights_;
  Stopwatch watch_;
  Materials found_;
  double psnr_ = 0;
};

}  // namespace

void RequireOneExposure(const Config& config) {
  if (!config.effects.exposure) return;
  throw InputError(
      "the photographs differ in exposure (effects.exposure), for which materials are not found; "
      "use photographs of one exposure, or, where they are, --effects -exposure");
}

void RequireOneEncoding(const Dataset& data) {
  if (data.linearized_photographs == 0) return;
  throw InputError(
      "{} of the photographs are display-referred (JPEG, PNG) among linear ones (EXR, HDR), so "
      "their scales differ and no materials are found; use photographs of one kind",
      data.linearized_photographs);
}

std::optional<MaterialsFound> TrainMaterials(const ModelSnapshot& field, const PosedImages& posed,
                                             const Dataset& data, const MaterialPlan& plan,
                                             const std::atomic<bool>& stop,
                                             const PipelineListener& listener) {
  RequireOneExposure(field.GetConfig());
  RequireOneEncoding(data);
  return MaterialTraining(field, posed, data, plan, stop, listener).Run();
}

}  // namespace nerf
