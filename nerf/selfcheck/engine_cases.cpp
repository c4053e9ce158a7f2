// Whole rays through both engines, on fields whose pixels are known.
#include <algorithm>
#include <cmath>

#include "nerf/field/radiance_field.h"
#include "nerf/selfcheck/known_field.h"
#include "nerf/selfcheck/numeric_case.h"

namespace nerf {
namespace {

constexpr double kNear = 0.05, kFar = 0.95;  // inside the unit ball, where space is not contracted
const std::vector<double> kColour = {0.9, 0.1, 0.3};

MarchOptions Inside(double stop_transmittance = 1e-9) {
  MarchOptions march;
  march.near_distance = kNear;
  march.far_distance = kFar;
  march.stop_transmittance = stop_transmittance;
  return march;
}

double Background(int channel) {
  return static_cast<double>(0.2f * static_cast<float>(channel + 1));
}

// Calls `check(engine, field)` for both engines, sampling by occupancy grid and by proposal
// network.
template <class Check>
void ForEachEngine(double density, const MarchOptions& march, const Check& check) {
  for (const bool with_proposal : {false, true}) {
    KnownField known(density, kColour, march, with_proposal);
    for (const auto& engine : known.Engines()) check(*engine, known);
  }
}

double FogOfAnyDensityFollowsBeerAndLambert() {
  WorstError worst;
  const TargetBatch batch = KnownField::RaysFromTheOrigin(17);
  for (const double density : {1e-6, 1e-3, 0.5, 7.0, 100.0}) {
    ForEachEngine(density, Inside(), [&](Engine& engine, KnownField&) {
      const RenderOutput out = engine.Render(batch.rays);
      const double opacity = -std::expm1(-density * (kFar - kNear));
      for (std::int64_t r = 0; r < batch.rays.Size(); ++r) {
        worst.AddRelative(out.opacity[r], opacity);
        for (int c = 0; c < 3; ++c) {
          const double truth = opacity * kColour[c] + (1 - opacity) * Background(c);
          worst.AddRelative(out.rgb[3 * r + c], truth);
        }
      }
    });
  }
  return worst.Get();
}

double InsideDenseMatterItsColourIsSeen() {
  WorstError worst;
  const TargetBatch batch = KnownField::RaysFromTheOrigin(17);
  ForEachEngine(1e6, Inside(1e-4), [&](Engine& engine, KnownField& known) {
    const RenderOutput out = engine.Render(batch.rays);
    for (std::int64_t r = 0; r < batch.rays.Size(); ++r) {
      for (int c = 0; c < 3; ++c) worst.AddRelative(out.rgb[3 * r + c], kColour[c]);
      worst.Require(out.depth[r] >= kNear && out.depth[r] <= kNear + 0.1);
    }
    engine.AccumulateGradients(batch);
    for (const double g : known.TakeGradients()) worst.RequireFinite(g);
  });
  return worst.Get();
}

// The gradient of the loss by the logarithm of the density, which one weight of the density network
// scales, in closed form.
double GradientsOfFogMatchTheFormula() {
  WorstError worst;
  const TargetBatch batch = KnownField::RaysFromTheOrigin(17);
  for (const double density : {1e-4, 0.5, 7.0}) {
    ForEachEngine(density, Inside(), [&](Engine& engine, KnownField& known) {
      engine.AccumulateGradients(batch);
      const torch::Tensor weight = known.Field().DensityNetwork().Weight(1);
      const double found = weight.grad()[0][0].item<double>();
      known.TakeGradients();
      // The Huber loss is quadratic up to an error of 0.1 and linear above.
      const double tau = density * (kFar - kNear), T = std::exp(-tau);
      double expected = 0;
      for (int c = 0; c < 3; ++c) {
        const double error = (1 - T) * kColour[c] + T * Background(c) - 0.5;
        const double slope = std::fabs(error) <= 0.1 ? error / 0.1 : std::copysign(1.0, error);
        expected += slope / 3 * T * tau * (kColour[c] - Background(c));
      }
      worst.AddRelative(found, expected);
    });
  }
  return worst.Get();
}

double EarlyTerminationCostsLessThanItsBound() {
  WorstError worst;
  constexpr double kStop = 1e-3;
  const TargetBatch batch = KnownField::RaysFromTheOrigin(17);
  ForEachEngine(20.0, Inside(kStop), [&](Engine& engine, KnownField&) {
    const RenderOutput out = engine.Render(batch.rays);
    const double opacity = -std::expm1(-20.0 * (kFar - kNear));
    worst.Require(out.opacity[0] < 1);  // the ray did stop early
    for (std::int64_t r = 0; r < batch.rays.Size(); ++r) {
      for (int c = 0; c < 3; ++c) {
        const double truth = opacity * kColour[c] + (1 - opacity) * Background(c);
        worst.Add(std::fabs(static_cast<double>(out.rgb[3 * r + c]) - truth) / kStop);
      }
    }
  });
  return worst.Get();
}

double DepthStaysBetweenNearAndFar() {
  WorstError worst;
  const TargetBatch batch = KnownField::RaysFromTheOrigin(17);
  for (const double density : {1e-6, 1e-3, 1.0, 1e4}) {
    ForEachEngine(density, Inside(), [&](Engine& engine, KnownField&) {
      for (const float depth : engine.Render(batch.rays).depth) {
        worst.Require(depth >= static_cast<float>(kNear) && depth <= static_cast<float>(kFar));
      }
    });
  }
  return worst.Get();
}

double NoRaysGiveEmptyOutput() {
  WorstError worst;
  ForEachEngine(1.0, Inside(), [&](Engine& engine, KnownField&) {
    const RenderOutput out = engine.Render(RayBatch());
    worst.Require(out.rgb.empty() && out.opacity.empty() && out.depth.empty());
    const StepResult step = engine.AccumulateGradients(TargetBatch());
    worst.Require(step.loss == 0 && step.shaded == 0);
  });
  return worst.Get();
}

// Values and gradients of a random field, one engine against the other.
double BothEnginesAgree() {
  WorstError worst;
  for (const bool with_proposal : {false, true}) {
    MarchOptions march;  // out to 100, through the contraction
    march.steps_per_unit = 32;
    KnownField known(1.0, kColour, march, with_proposal);
    {
      const torch::NoGradGuard no_grad;
      torch::manual_seed(3);
      for (auto& parameter : known.Field().parameters()) parameter.normal_(0.0, 0.4);
    }
    const TargetBatch batch = KnownField::RaysFromTheOrigin(61);
    std::vector<RenderOutput> out;
    std::vector<std::vector<double>> gradients;
    for (const auto& engine : known.Engines()) {
      out.push_back(engine->Render(batch.rays));
      engine->AccumulateGradients(batch);
      gradients.push_back(known.TakeGradients());
    }
    for (std::size_t i = 0; i < out[0].rgb.size(); ++i) {
      worst.Add(std::fabs(static_cast<double>(out[0].rgb[i] - out[1].rgb[i])));
    }
    double largest = 0;
    for (const double g : gradients[0]) largest = std::max(largest, std::fabs(g));
    worst.Require(largest > 0 && gradients[0].size() == gradients[1].size());
    for (std::size_t i = 0; i < gradients[0].size(); ++i) {
      worst.Add(std::fabs(gradients[0][i] - gradients[1][i]) / largest);
    }
  }
  return worst.Get();
}

}  // namespace

std::vector<NumericCase> EngineCases() {
  return {
      {"FogOfAnyDensityFollowsBeerAndLambert", "both engines, relative", Within(2e-6, 2.7e-7), true,
       FogOfAnyDensityFollowsBeerAndLambert},
      {"InsideDenseMatterItsColourIsSeen", "both engines, relative", Within(4e-7, 4.0e-8), true,
       InsideDenseMatterItsColourIsSeen},
      {"GradientsOfFogMatchTheFormula", "both engines, relative", Within(2e-4, 3.9e-5), true,
       GradientsOfFogMatchTheFormula},
      {"EarlyTerminationCostsLessThanItsBound", "both engines, parts of the bound", Within(1, 0.67),
       true, EarlyTerminationCostsLessThanItsBound},
      {"DepthStaysBetweenNearAndFar", "inside or not", kExact, true, DepthStaysBetweenNearAndFar},
      {"NoRaysGiveEmptyOutput", "empty or not", kExact, true, NoRaysGiveEmptyOutput},
      {"BothEnginesAgree", "one engine against the other", Within(3.9e-6, 3.9e-7), true,
       BothEnginesAgree},
  };
}

}  // namespace nerf
