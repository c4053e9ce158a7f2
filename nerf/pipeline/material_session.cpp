#include "nerf/pipeline/material_session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/image/image_io.h"
#include "nerf/model/refined_poses.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/prepared_scene.h"
#include "nerf/pipeline/surface_extraction.h"
#include "nerf/relight/environment_light.h"
#include "nerf/train/material_fit.h"
#include "sfm/transforms_json.h"

namespace nerf {
namespace {

// Shadow rays begin at this distance from the surface, in cells.
constexpr double kShadowOffset = 1.5;
// Of the material field, in cells of the surface.
constexpr int kFinerThanSurface = 2;
constexpr std::int64_t kStepsBetweenEvents = 20;
constexpr int kEnvironmentHeight = 32;
constexpr double kFileSeconds = 1;  // for the files

Eigen::AlignedBox3d BoxOf(const ScalarGrid& grid) {
  return {grid.origin, grid.PositionOf(grid.size.x() - 1, grid.size.y() - 1, grid.size.z() - 1)};
}

void RequireOneExposure(const Model& field) {
  if (field.exposure != nullptr) {
    throw InputError(
        "the photographs differ in exposure, for which materials are not found yet; use "
        "photographs "
        "of one exposure");
  }
}

torch::Tensor KnownLight(const MaterialRequest& request, const SceneNormalization& frame) {
  if (!request.light) return {};
  return RadianceFrom(*request.light, LightDirections(request.options.directions),
                      MapFromFrame(frame.rotation)) *
         std::exp2(request.light_exposure);
}

// The fit, until its steps or its time end.
class Fitting {
 public:
  Fitting(const MaterialRequest& request, const Stopwatch& watch, MaterialFit& fit)
      : request_(request), watch_(watch), fit_(fit), begin_(watch.Seconds()) {}

  // False where it was stopped.
  bool Run(const std::atomic<bool>& stop, const PipelineListener& listener) {
    double sum = 0;
    std::int64_t summed = 0;
    for (double fraction = 0; fraction < 1; fraction = Fraction()) {
      if (stop) return false;
      sum += fit_.Step(fraction);
      if (++summed < kStepsBetweenEvents) continue;
      psnr_ = -10 * std::log10(sum / static_cast<double>(summed));
      listener(MaterialsStepped{fit_.Steps(), Fraction(), psnr_});
      sum = 0;
      summed = 0;
    }
    return true;
  }
  double Psnr() const { return psnr_; }

 private:
  double Fraction() const {
    if (request_.time_budget == 0) {
      return static_cast<double>(fit_.Steps()) / static_cast<double>(request_.steps);
    }
    const double end = std::max(begin_ + 1, request_.time_budget - kFileSeconds);
    return (watch_.Seconds() - begin_) / (end - begin_);
  }

  const MaterialRequest& request_;
  const Stopwatch& watch_;
  MaterialFit& fit_;
  double begin_;
  double psnr_ = 0;
};

}  // namespace

std::optional<MaterialSession> FindMaterials(const MaterialRequest& request, const Stopwatch& watch,
                                             const std::atomic<bool>& stop,
                                             const PipelineListener& listener) {
  const OpenedRun run = OpenRun(request.run);
  const Model& field = run.model->GetModel();
  const SceneNormalization& frame = field.scene.normalized_from_world;
  RequireOneExposure(field);
  const Dataset data = LoadPhotographs(sfm::ReadTransformsJson(PosesPath(request.run)),
                                       field.config, frame, request.run, listener);
  std::vector<TargetView> views = TargetViewsOf(data.train);
  std::vector<ObservedView> observed;
  for (TargetView& view : views) {
    RefineView(field, view.photograph->name, view.photograph->lens, view.normalized_from_camera,
               view.camera);
    observed.push_back({view.photograph, view.camera, view.normalized_from_camera});
  }
  SurfaceExtractionOptions extraction;
  extraction.resolution = request.options.surface_resolution;
  auto surface = ExtractSurface(*run.model, views, extraction, stop, [&](std::size_t done) {
    listener(SurfacesRendered{done, views.size()});
  });
  if (!surface) return std::nullopt;

  const MeshRays rays(surface->mesh);
  SurfaceObservations observations = ObserveSurface(observed, data.encoding, surface->mesh, rays);
  if (observations.Size() == 0) {
    throw InputError("{}: no photograph shows the surface of the field; train longer",
                     request.run.string());
  }
  LightTransport transport = TraceLight(surface->mesh, rays, request.options.directions,
                                        static_cast<float>(kShadowOffset * surface->distance.cell));
  MaterialSession session;
  Materials& found = session.materials;
  found.options = request.options;
  found.resolution = kFinerThanSurface * extraction.resolution;
  found.field_step = run.model->Step();
  found.surface.field = std::make_shared<MaterialField>(BoxOf(surface->distance), found.resolution,
                                                        field.config.train.seed);
  found.surface.normal_offset = request.options.normal_offset;
  MaterialFit fit(std::move(observations), std::move(transport), found.surface.field,
                  request.options, field.config.train.seed, KnownLight(request, frame));
  Fitting fitting(request, watch, fit);
  session.finished = fitting.Run(stop, listener);
  session.psnr = fitting.Psnr();
  found.steps = fit.Steps();
  found.surface.light = fit.Light();
  found.surface.distance = std::move(surface->distance);
  found.surface.mesh = std::move(surface->mesh);
  WriteMaterials(found, MaterialsPath(request.run));
  WriteImage(EnvironmentPath(request.run), EnvironmentImage(found.surface.light, kEnvironmentHeight,
                                                            MapFromFrame(frame.rotation)));
  return session;
}

}  // namespace nerf
