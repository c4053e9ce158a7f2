#pragma once

#include <memory>

#include "nerf/config/config.h"

namespace nerf {

class Background;
class Exposure;
class OccupancyGrid;
class PoseRefinement;
class ProposalField;
class RadianceField;

// Coarse-to-fine schedules during training; 1 for a finished model.
struct Annealing {
  double detail = 1;    // of the field, in [0,1]: see RadianceField
  double proposal = 1;  // exponent of the proposal's weights, in [0,1]: see ProposalField
};

// The modules of a model and the configuration they were created from. Engines and renderers keep a
// reference to it: it must outlive them and must not be moved.
struct ModelParts {
  Config config;
  Annealing annealing;
  std::shared_ptr<RadianceField> field;
  std::shared_ptr<OccupancyGrid> grid;
  std::shared_ptr<ProposalField> proposal;  // null: the occupancy grid places the samples
  std::shared_ptr<Background> background;   // null where the effect is off, as those below
  std::shared_ptr<Exposure> exposure;
  std::shared_ptr<PoseRefinement> pose_refinement;
};

}  // namespace nerf
