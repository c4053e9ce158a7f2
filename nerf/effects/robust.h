#pragma once

#include "nerf/base/options.h"
#include "nerf/effects/effect.h"

namespace nerf {

struct PhotographFit;
struct TrackColors;

// A robust loss against transient objects, which only one or two photographs show: passers-by,
// moving shadows. A ray's loss l becomes l / (1 + l / scale), so that outliers have little weight.
// Source: Geman and McClure 1985.
struct RobustOptions {
  double scale = 0.05;

  // The options at a stage of training. At the beginning all errors are large and informative, so
  // the scale starts at a hundred times its value and falls exponentially to it over the first half
  // of training.
  //   progress  in [0, 1]
  RobustOptions At(double progress) const;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("scale", o.scale, "loss", Above(0),
           "loss of a ray whose gradients have a quarter of their weight at the end of training");
  }
};

// The robust loss of a ray, and its derivative with respect to the ray's loss, which is the weight
// of the ray's gradients. For scalars or tensors >= 0. Differentiable.
template <class T>
T RobustLoss(const T& loss, const RobustOptions& options) {
  return loss / (1 + loss / options.scale);
}
template <class T>
T RobustWeight(const T& loss, const RobustOptions& options) {
  const T excess = 1 + loss / options.scale;
  return 1 / (excess * excess);
}

// Judges by the share of places where a point should be visible but something else is.
Verdict JudgeRobust(const TrackColors& colors, const PhotographFit& fit);

extern const EffectDescriptor kRobustEffect;

}  // namespace nerf
