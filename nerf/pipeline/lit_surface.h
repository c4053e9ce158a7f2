#pragma once

#include <atomic>
#include <optional>

#include "nerf/config/material_options.h"
#include "nerf/geometry/mesh_rays.h"
#include "nerf/model/snapshot.h"
#include "nerf/pipeline/events.h"
#include "nerf/pipeline/photograph_lights.h"
#include "nerf/pipeline/surface_extraction.h"
#include "nerf/scene/dataset.h"
#include "nerf/train/material_fit.h"

namespace nerf {

// Shadow rays begin at this distance from a surface, in cells.
inline constexpr double kShadowOffset = 1.5;

// The training photographs of a capture at the poses that a field has refined.
std::vector<TargetView> RefinedViews(const Model& field, const Dataset& data);

// The surface of a field on which its depths agree at the poses of the photographs.
//   returns  nullopt where it was stopped
std::optional<ExtractedSurface> SurfaceOf(const ModelSnapshot& field, const Dataset& data,
                                          const MaterialOptions& options,
                                          const std::atomic<bool>& stop,
                                          const PipelineListener& listener);

// What photographs show of a surface under their lights; without the shadows of the environment
// (AddShadows).
//   field  of which the poses are
// Throws InputError where no photograph shows the surface.
LitSurface Observe(const Model& field, const Dataset& data, const ExtractedSurface& surface,
                   const MeshRays& rays, const PhotographLights& lights, int directions);

// Traces which directions are blocked.
void AddShadows(const ExtractedSurface& surface, const MeshRays& rays, bool has_bounces,
                LitSurface& lit);

// Without shadows a lamp shines on everything.
void RemoveShadows(LitSurface& lit);

}  // namespace nerf
