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

// How much of a field in training is active; a finished model has 1 for both.
struct Annealing {
  double detail = 1;    // of the field, in [0,1]: see RadianceField
  double proposal = 1;  // exponent of the proposal's weights, in [0,1]: see ProposalField
};

// The modules of a model with the configuration that they were made from. Engines and renderers
// borrow it: it must outlive them and stay in its place.
struct ModelParts {
  Config config;
  Annealing annealing;
  std::shared_ptr<RadianceField> field;
  std::shared_ptr<OccupancyGrid> grid;
  std::shared_ptr<ProposalField> proposal;  // null: the grid places the samples
  std::shared_ptr<Background> background;   // null where it is not learned; so with those below
  std::shared_ptr<Exposure> exposure;
  std::shared_ptr<PoseRefinement> pose_refinement;
};

}  // namespace nerf
