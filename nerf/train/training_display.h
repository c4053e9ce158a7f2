#pragma once

#include <string>

#include "nerf/base/progress.h"
#include "nerf/train/quality_curve.h"

namespace nerf {

// What quality cost, and what more of it will:
// "27.30 dB, last +0.5 dB cost 40 s, next about 90 s".
std::string PriceOfQuality(const QualityCurve& curve);

// The line that a person sees while training runs.
class TrainingDisplay {
 public:
  //   total, done  steps, or seconds where a time budget decides
  TrainingDisplay(std::int64_t total, std::int64_t done) : progress_("training", total, done) {}

  void Update(std::int64_t done, double loss, double rays_per_second, const QualityCurve& curve);

 private:
  ProgressLine progress_;
  double loss_ = 0, rays_per_second_ = 0;  // running means
};

}  // namespace nerf
