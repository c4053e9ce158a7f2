#pragma once

#include <string>

#include "nerf/kernels/hash_encoding.h"

namespace nerf {

// Where the samples of a ray stand when a small density field, the proposal, chooses their places
// and not the occupancy grid.
// Source: Barron et al. 2022, "Mip-NeRF 360", section 3; the hash-encoded proposal of Tancik et al.
// 2023, "Nerfstudio".
struct ProposalOptions {
  int intervals = 40;        // of equal length in contracted space, at which the proposal is asked
  int samples = 24;          // intervals that its weights are cut into, for the field
  double padding = 0.01;     // share of an even spread in the weights, so that no place is given up
  int anneal_steps = 500;    // steps from an even spread to the proposal's own weights
  double loss_weight = 1.0;  // of the proposal's loss (kernels::HistogramBoundLoss)
  double distortion = 0.03;  // weight of kernels::DistortionLoss, against floaters
  int hidden_width = 16;
  kernels::HashGridOptions encoding = {5, 2, 15, 16, 256};

  void Check() const;
};

}  // namespace nerf
