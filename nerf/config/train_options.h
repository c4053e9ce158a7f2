#pragma once

#include <cstdint>
#include <utility>

#include "nerf/base/options.h"
#include "nerf/kernels/mlp.h"

namespace nerf {

enum class EngineKind { kFused, kLibTorch };
template <>
struct EnumNames<EngineKind> {
  static constexpr std::pair<EngineKind, std::string_view> kNames[] = {
      {EngineKind::kFused, "fused"}, {EngineKind::kLibTorch, "libtorch"}};
};

template <>
struct EnumNames<kernels::Precision> {
  static constexpr std::pair<kernels::Precision, std::string_view> kNames[] = {
      {kernels::Precision::kFloat, "float"}, {kernels::Precision::kBfloat16, "bfloat16"}};
};

// What a training makes of a scene: the neural field alone, or Gaussians as well, which begin at
// the surfaces of the field. kAuto: a trial decides.
enum class Representation { kAuto, kField, kSplats };
template <>
struct EnumNames<Representation> {
  static constexpr std::pair<Representation, std::string_view> kNames[] = {
      {Representation::kAuto, "auto"},
      {Representation::kField, "field"},
      {Representation::kSplats, "splats"}};
};

enum class LossKind { kHuber, kMse };
template <>
struct EnumNames<LossKind> {
  static constexpr std::pair<LossKind, std::string_view> kNames[] = {{LossKind::kHuber, "huber"},
                                                                     {LossKind::kMse, "mse"}};
};

// The colour loss (nerf/render/losses.h).
struct LossOptions {
  LossKind kind = LossKind::kHuber;
  double huber_delta = 0.1;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("kind", o.kind, "loss of a colour channel: Huber or mean squared error");
    option("huber_delta", o.huber_delta, "colour", Above(0), "errors above this count linearly");
  }
};

// Adam (nerf/train/optimizer.h).
struct OptimizerOptions {
  double learning_rate = 1e-2;
  double beta1 = 0.9;
  double beta2 = 0.99;
  double epsilon = 1e-15;
  double weight_decay = 1e-6;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("learning_rate", o.learning_rate, "", AboveUpTo(0, 1e6),
           "at its highest; see the block schedule");
    option("beta1", o.beta1, "", Between(0, 0.9999), "decay of the mean of gradients");
    option("beta2", o.beta2, "", Between(0, 0.9999), "decay of the mean of squared gradients");
    option("epsilon", o.epsilon, "", Above(0), "added to the root of the mean square");
    option("weight_decay", o.weight_decay, "", AtLeast(0),
           "of the networks' weights, not of the hash tables");
  }
};

// Space close to a camera is sampled more densely than the scene and gets larger gradients, which
// causes floaters there. Scaling the gradients of a sample at distance t by
// min(1, (t / full_distance)^2) compensates for that. Source: Philip and Deschaintre 2023,
// "Floaters No More: Radiance Field Gradient Scaling for Improved Near-Camera Training".
struct GradientScalingOptions {
  double full_distance = 2.0;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("full_distance", o.full_distance, "normalized units", AtLeast(0),
           "gradients of nearer samples are scaled by (t / full_distance)^2; 0: none are");
  }
};

// Learning-rate schedule: linear warm-up, then cosine decay to the final value.
struct ScheduleOptions {
  int warmup_steps = 50;
  double final_factor = 0.01;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("warmup_steps", o.warmup_steps, "steps", AtLeast(0), "of the linear rise");
    option("final_factor", o.final_factor, "", AboveUpTo(0, 1),
           "last learning rate over the highest");
  }
};
// The learning rate at a step, divided by the configured one.
//   progress  fraction of the whole run, in [0, 1]
double LearningRateFactor(const ScheduleOptions& schedule, std::int64_t step, double progress);

struct TrainOptions {
  Representation representation = Representation::kAuto;
  EngineKind engine = EngineKind::kFused;
  kernels::Precision precision = kernels::Precision::kFloat;
  std::int64_t steps = 5000;
  double time_budget = 0;
  double target_psnr = 0;
  std::int64_t samples_per_batch = 32768;
  std::int64_t max_rays_per_batch = 4096;
  double error_driven_share = 0.5;
  std::uint64_t seed = 1;
  std::int64_t checkpoint_every = 500;
  std::int64_t validate_every = 250;

  // Checks combinations of options that single ranges cannot express. Throws InputError.
  void Check() const;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("representation", o.representation,
           "the field alone, Gaussians as well, or what a trial on validation photographs says");
    option("engine", o.engine,
           "fused kernels, or LibTorch, the definition they are tested against");
    option("precision", o.precision,
           "factors of the field's matrix products in the fused engine; sums stay float");
    option("steps", o.steps, "steps", AtLeast(1), "length of a run without a time budget");
    option("time_budget", o.time_budget, "seconds", ZeroOr(Between(1, 30 * 24 * 3600)),
           "of the whole command; the learning rate then falls by the clock; 0: steps decide");
    option("target_psnr", o.target_psnr, "dB", Between(0, 100),
           "training ends early where validation reaches it; 0: it never does");
    option("samples_per_batch", o.samples_per_batch, "samples", Between(1, 1 << 24),
           "with gradients, that a step aims at");
    option("max_rays_per_batch", o.max_rays_per_batch, "rays", Between(1, 1 << 22),
           "most rays of a step");
    option("error_driven_share", o.error_driven_share, "of rays", Between(0, 1),
           "drawn where the field is still wrong (ErrorMap); the others anywhere");
    option("seed", o.seed, "", AtLeast(0), "of all random numbers");
    option("checkpoint_every", o.checkpoint_every, "steps", AtLeast(1), "between checkpoints");
    option("validate_every", o.validate_every, "steps", AtLeast(1), "between validations");
  }
};

}  // namespace nerf
