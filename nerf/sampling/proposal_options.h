#pragma once

#include <string>

#include "nerf/kernels/hash_encoding.h"

namespace nerf {

// Sample placement by a proposal network, a small density field, instead of the occupancy grid.
// Source: Barron et al. 2022, "Mip-NeRF 360", section 3; the hash-encoded proposal of Tancik et al.
// 2023, "Nerfstudio".
struct ProposalOptions {
  int intervals = 40;        // of equal length in contracted space, where the network is evaluated
  int samples = 24;          // of the field, resampled from the network's weights
  double padding = 0.01;     // uniform share of the weights, so that every part is still sampled
  int anneal_steps = 500;    // training steps from uniform weights to the network's own
  double loss_weight = 1.0;  // of kernels::HistogramBoundLoss, which trains the network
  double distortion = 0.03;  // weight of kernels::DistortionLoss, against floaters
  int hidden_width = 16;
  kernels::HashGridOptions encoding = {5, 2, 15, 16, 256};

  void Check() const;
};

}  // namespace nerf
