#pragma once

namespace nerf {

// What stands in a photograph or two and in no other: passers-by, shadows that move. A ray's loss
// l counts as l / (1 + l / scale), so that a large one, which nothing can make small, pulls little.
// Source: Geman and McClure 1985.
struct RobustOptions {
  double scale = 0.05;  // the loss of a ray whose pull is a quarter of what it was, in the end

  // At the beginning every ray is wrong, and those that are the most wrong have the most to tell:
  // the scale falls from a hundred times as much, along a power, until half of the training is
  // over.
  //   progress  in [0, 1]
  RobustOptions At(double progress) const;

  void Check() const;
};

// What a ray's loss counts as, and the derivative of that by the loss: the part of its pull that is
// left. Of numbers or of tensors; >= 0.
template <class T>
T RobustLoss(const T& loss, const RobustOptions& options) {
  return loss / (1 + loss / options.scale);
}
template <class T>
T RobustPull(const T& loss, const RobustOptions& options) {
  const T excess = 1 + loss / options.scale;
  return 1 / (excess * excess);
}

}  // namespace nerf
