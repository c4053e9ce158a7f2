#pragma once

#include "nerf/base/options.h"
#include "nerf/kernels/hash_encoding.h"

namespace nerf {

// Sample placement by a proposal network, a small density field, instead of the occupancy grid.
// Source: Barron et al. 2022, "Mip-NeRF 360", section 3; the hash-encoded proposal of Tancik et al.
// 2023, "Nerfstudio".
struct ProposalOptions {
  int intervals = 40;
  int samples = 24;
  double padding = 0.01;
  int anneal_steps = 500;
  double loss_weight = 1.0;
  double distortion = 0.03;
  int hidden_width = 16;
  kernels::HashGridOptions encoding = {5, 2, 15, 16, 256};

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("intervals", o.intervals, "", Between(2, 1024),
           "of equal length in contracted space, at which the proposal network is evaluated");
    option("samples", o.samples, "a ray", Between(1, 1024),
           "for the field, resampled by the proposal's weights");
    option("padding", o.padding, "", AboveUpTo(0, 1),
           "uniform share of the weights, so that no place is given up");
    option("anneal_steps", o.anneal_steps, "steps", Between(0, 1 << 24),
           "from an even spread of the samples to the proposal's own weights");
    option("loss_weight", o.loss_weight, "", AtLeast(0), "of the proposal's interlevel loss");
    option("distortion", o.distortion, "", AtLeast(0),
           "weight of the distortion loss, against floaters");
    option("hidden_width", o.hidden_width, "neurons", Between(1, 256), "of the proposal network");
    option("encoding", o.encoding, "hash encoding of the proposal network");
  }
};

}  // namespace nerf
