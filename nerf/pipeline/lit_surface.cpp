#include "nerf/pipeline/lit_surface.h"

#include <algorithm>
#include <cmath>

#include "nerf/base/input_error.h"
#include "nerf/model/refined_poses.h"
#include "nerf/relight/rows.h"

namespace nerf {
namespace {

void AddLamps(const MeshRays& rays, float offset, LitSurface& lit) {
  std::vector<std::vector<Lamp>> of_groups;
  for (const LightGroup& group : lit.lights) of_groups.push_back(group.lamps);
  const LampTable lamps(of_groups);
  if (lamps.Most() == 0) return;
  const SurfaceObservations& seen = lit.observations;
  lit.lamp_visibility = lamps.Visibility(seen.position, seen.normal, seen.group, rays, offset);
  const std::int64_t vertices = lit.vertex_position.size(0);
  std::vector<torch::Tensor> at_vertices;
  for (std::size_t g = 0; g < of_groups.size(); ++g) {
    const torch::Tensor group = torch::full({vertices}, static_cast<std::int64_t>(g), torch::kLong);
    at_vertices.push_back(
        lamps.Visibility(lit.vertex_position, lit.vertex_normal, group, rays, offset));
  }
  lit.vertex_lamp_visibility = torch::stack(at_vertices);
}

}  // namespace

std::vector<TargetView> RefinedViews(const Model& field, const Dataset& data) {
  std::vector<TargetView> views = TargetViewsOf(data.train);
  for (TargetView& view : views) {
    RefineView(field, view.photograph->name, view.photograph->lens, view.normalized_from_camera,
               view.camera);
  }
  return views;
}

std::optional<ExtractedSurface> SurfaceOf(const ModelSnapshot& field, const Dataset& data,
                                          const MaterialOptions& options,
                                          const std::atomic<bool>& stop,
                                          const PipelineListener& listener) {
  const std::vector<TargetView> views = RefinedViews(field.GetModel(), data);
  SurfaceExtractionOptions extraction;
  extraction.resolution = options.surface_resolution;
  return ExtractSurface(field, views, extraction, stop, [&](std::size_t done) {
    listener(SurfacesRendered{done, views.size()});
  });
}

LitSurface Observe(const Model& field, const Dataset& data, const ExtractedSurface& surface,
                   const MeshRays& rays, const PhotographLights& lights, int directions) {
  std::vector<ObservedView> observed;
  for (const TargetView& view : RefinedViews(field, data)) {
    observed.push_back({view.photograph, view.camera, view.normalized_from_camera,
                        lights.group_of.at(view.photograph->name)});
  }
  LitSurface lit;
  lit.observations = ObserveSurface(observed, data.encoding, surface.mesh, rays);
  if (lit.observations.Size() == 0) {
    throw InputError("no photograph shows the surface of the field; train longer");
  }
  lit.lights = lights.groups;
  lit.transport.directions = LightDirections(directions);
  lit.has_bounces = false;
  lit.vertex_position = RowsOf(surface.mesh.vertices);
  lit.vertex_normal = RowsOf(surface.mesh.normals);
  AddLamps(rays, static_cast<float>(kShadowOffset * surface.distance.cell), lit);
  return lit;
}

void AddShadows(const ExtractedSurface& surface, const MeshRays& rays, bool has_bounces,
                LitSurface& lit) {
  lit.transport = TraceLight(surface.mesh, rays, static_cast<int>(lit.transport.directions.size(0)),
                             static_cast<float>(kShadowOffset * surface.distance.cell));
  lit.has_bounces = has_bounces;
}

void RemoveShadows(LitSurface& lit) {
  if (!lit.lamp_visibility.defined()) return;
  lit.lamp_visibility.fill_(1);
  lit.vertex_lamp_visibility.fill_(1);
}

}  // namespace nerf
