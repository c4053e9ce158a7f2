#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>

#include "nerf/base/stopwatch.h"
#include "nerf/pipeline/events.h"
#include "nerf/train/material_fit.h"

namespace nerf {

// A fit with its time or its steps.
class MaterialFitting {
 public:
  //   steps, seconds  of the whole fit; seconds 0: by steps
  //   spent           seconds, before
  MaterialFitting(MaterialFit& fit, std::int64_t steps, double seconds, double spent)
      : fit_(fit), steps_(steps), seconds_(seconds), spent_(spent) {}

  double Seconds() const { return spent_ + watch_.Seconds(); }
  double PlannedSeconds() const { return seconds_; }
  std::int64_t PlannedSteps() const { return steps_; }
  double Psnr() const { return psnr_; }

  // False where it was stopped.
  //   save  called after `checkpoint_every` steps
  bool Run(std::int64_t checkpoint_every, const std::function<void()>& save,
           const std::atomic<bool>& stop, const PipelineListener& listener) {
    double sum = 0;
    std::int64_t summed = 0;
    for (double fraction = Fraction(); fraction < 1; fraction = Fraction()) {
      if (stop) return false;
      sum += fit_.Step(fraction);
      if (checkpoint_every > 0 && fit_.Steps() % checkpoint_every == 0) save();
      psnr_ = -10 * std::log10(sum / static_cast<double>(++summed));
      if (summed < kStepsBetweenEvents) continue;
      listener(MaterialsStepped{fit_.Steps(), Fraction(), psnr_});
      sum = 0;
      summed = 0;
    }
    return true;
  }

 private:
  static constexpr std::int64_t kStepsBetweenEvents = 20;

  double Fraction() const {
    if (seconds_ > 0) return Seconds() / seconds_;
    return static_cast<double>(fit_.Steps()) / static_cast<double>(steps_);
  }

  MaterialFit& fit_;
  std::int64_t steps_;
  double seconds_, spent_;
  double psnr_ = 0;
  Stopwatch watch_;
};

}  // namespace nerf
