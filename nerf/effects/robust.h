#pragma once

#include "nerf/base/options.h"
#include "nerf/effects/effect.h"

namespace nerf {

// What stands in a photograph or two and in no other: passers-by, shadows that move. A ray's loss
// l counts as l / (1 + l / scale), so that a large one, which nothing can make small, has little
// weight. Source: Geman and McClure 1985.
struct RobustOptions {
  double scale = 0.05;

  // At the beginning every ray is wrong, and the most wrong ones have the most information: the
  // scale falls from a hundred times as much, along a power, until half of the training is over.
  //   progress  in [0, 1]
  RobustOptions At(double progress) const;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("scale", o.scale, "loss", Above(0),
           "loss of a ray whose gradients have a quarter of their weight at the end of training");
  }
};

// A ray's robust loss, and its derivative by the loss: the weight of the ray's gradients. Of
// numbers or of tensors; >= 0.
template <class T>
T RobustLoss(const T& loss, const RobustOptions& options) {
  return loss / (1 + loss / options.scale);
}
template <class T>
T RobustWeight(const T& loss, const RobustOptions& options) {
  const T excess = 1 + loss / options.scale;
  return 1 / (excess * excess);
}

// The share of places where a point should be seen and something else is.
Verdict JudgeRobust(const TrackColors& colors, const PhotographFit& fit);

extern const EffectDescriptor kRobust;

}  // namespace nerf
