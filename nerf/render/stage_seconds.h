#pragma once

namespace nerf {

// The time of each stage of rays. Within a tile it is that of one thread; for a whole batch it is
// divided by the number of threads, so that the stages of a step sum to at most its time.
struct StageSeconds {
  double sampling = 0;     // ray marching, or the proposal network with its training
  double encoding = 0;     // the field's hash table, with the scattering of its gradients
  double networks = 0;     // density and colour networks
  double compositing = 0;  // volume rendering, the loss, and their backward pass

  double Sum() const { return sampling + encoding + networks + compositing; }
  void Add(const StageSeconds& other, double factor = 1) {
    sampling += factor * other.sampling;
    encoding += factor * other.encoding;
    networks += factor * other.networks;
    compositing += factor * other.compositing;
  }
};

}  // namespace nerf
