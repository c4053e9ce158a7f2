#pragma once

namespace nerf {

// Where the time of rays goes, each stage by a timer of its own. Of one thread while a tile is
// under way; of a whole batch divided by the number of threads, so that the stages of a step sum to
// at most its time.
struct StageSeconds {
  double sampling = 0;     // where samples stand: the march, or the proposal with its training
  double encoding = 0;     // reading the field's hash table; in training, scattering its gradients
  double networks = 0;     // density and colour
  double compositing = 0;  // the integral along rays, the loss, and their backward pass

  double Sum() const { return sampling + encoding + networks + compositing; }
  void Add(const StageSeconds& other, double factor = 1) {
    sampling += factor * other.sampling;
    encoding += factor * other.encoding;
    networks += factor * other.networks;
    compositing += factor * other.compositing;
  }
};

}  // namespace nerf
