#pragma once

#include <cstdint>
#include <string>

namespace nerf {

struct LossOptions {
  std::string kind = "huber";  // "huber" or "mse"
  double huber_delta = 0.1;    // errors above this count linearly; same unit as colours

  void Check() const;
};

struct OptimizerOptions {
  double learning_rate = 1e-2;  // at its highest, see ScheduleOptions
  double beta1 = 0.9;
  double beta2 = 0.99;
  double epsilon = 1e-15;
  double weight_decay = 1e-6;  // of the networks' weights, not of the hash table

  void Check() const;
};

// A photograph alone could be painted on a pane of glass right before its camera: samples near the
// camera get gradients from many rays, those where the scene is from few. Scaling the gradients of
// a sample at distance t by min(1, (t / full_distance)^2) undoes that. Source: Philip and
// Deschaintre 2023, "Floaters No More".
struct GradientScalingOptions {
  double full_distance = 2.0;  // normalized scene units; 0: no scaling

  void Check() const;
};

// The learning rate rises linearly, then falls along half a cosine to its final value.
struct ScheduleOptions {
  int warmup_steps = 50;       // steps of the rise
  double final_factor = 0.01;  // last learning rate as a fraction of the highest

  void Check() const;
};
//   progress  in [0, 1], of the whole run
double LearningRateFactor(const ScheduleOptions& schedule, std::int64_t step, double progress);

struct TrainOptions {
  std::string engine = "fused";  // or "libtorch", the definition that it is tested against
  // Of the field's networks in the fused engine: "float", or "bfloat16" factors with float sums,
  // which takes less time on processors with AVX512-BF16 and more on others.
  std::string precision = "float";
  std::int64_t steps = 5000;
  // Seconds for the whole command, from reading photographs to the last checkpoint; the learning
  // rate falls by the clock, and steps do not count. 0: steps decide.
  double time_budget = 0;
  // Training ends early where the validation reaches so many dB. 0: it never does.
  double target_psnr = 0;
  std::int64_t samples_per_batch = 32768;  // samples with gradients that a step aims at
  std::int64_t max_rays_per_batch = 4096;
  // Of a batch, drawn where the field is still wrong (ErrorMap); the others anywhere.
  double error_driven_share = 0.5;
  std::uint64_t seed = 1;
  std::int64_t checkpoint_every = 500;  // steps
  std::int64_t validate_every = 250;    // steps

  void Check() const;
};

}  // namespace nerf
