#pragma once

namespace nerf {

// Where the time of rays on their way goes. Of one thread while a tile is under way; of a whole
// batch divided by the number of threads, so that the stages of a step sum to at most its time.
struct StageSeconds {
  double sampling = 0;     // where samples stand: the march, or the proposal with its training
  double encoding = 0;     // reading the field's hash table; in training, scattering its gradients
  double networks = 0;     // density and colour
  double compositing = 0;  // the loss, and what else a tile takes

  // Charges to compositing what the other stages leave of the time of a whole tile.
  void SetAll(double seconds) { compositing = seconds - sampling - encoding - networks; }
  double Sum() const { return sampling + encoding + networks + compositing; }
  void Add(const StageSeconds& other, double factor = 1) {
    sampling += factor * other.sampling;
    encoding += factor * other.encoding;
    networks += factor * other.networks;
    compositing += factor * other.compositing;
  }
};

}  // namespace nerf
