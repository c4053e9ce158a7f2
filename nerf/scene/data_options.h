#pragma once

#include "nerf/base/options.h"

namespace nerf {

// Which photographs are trained on, and how they are read.
struct DataOptions {
  int downscale = 1;
  int film_frames = 0;
  double points_share = 0.08;
  int test_every = 8;
  int validation_images = 16;
  int memory_mb = 1024;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("downscale", o.downscale, "", AtLeast(1),
           "photographs are area-averaged by this factor");
    option("film_frames", o.film_frames, "", ZeroOr(Between(2, 10000)),
           "how many frames of a film are used; 0: three a second, 40 to 150");
    option("points_share", o.points_share, "of a time budget", Between(0, 1),
           "how long finding sparse points may take where the input has poses but no points, which "
           "most verdicts on effects need; without a budget, as long as the training; 0: never");
    option("test_every", o.test_every, "", ZeroOr(AtLeast(2)),
           "hold out images 0, 8, 16, ... by name; 0: none");
    option("validation_images", o.validation_images, "", AtLeast(0),
           "at most; one in sixteen of the training images, but at least 3 (2 of fewer than 24), "
           "is taken out to measure "
           "progress, at poses that stand for all; 0: none");
    option("memory_mb", o.memory_mb, "MB", AtLeast(1),
           "for pixels; where they do not fit, an even random share is held");
  }
};

}  // namespace nerf
