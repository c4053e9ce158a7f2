#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "nerf/field/background.h"
#include "nerf/field/exposure.h"
#include "nerf/field/libtorch.h"
#include "nerf/field/pose_refinement.h"
#include "nerf/field/proposal_field.h"
#include "nerf/field/radiance_field.h"
#include "nerf/render/fused_engine.h"
#include "nerf/render/libtorch_engine.h"
#include "nerf/sampling/occupancy_grid.h"

namespace nerf::test {

// Both engines on the same field, with a batch of rays.
struct TwoEngines {
  kernels::HashGridOptions encoding;
  FieldOptions field_options;
  ColorEncoding color = ColorEncoding::kSrgb;
  std::shared_ptr<ProposalField> proposal;
  ProposalOptions proposal_options;
  MarchOptions march;
  LossOptions loss;
  GradientScalingOptions gradient_scaling;
  ColorModel color_model = ColorModel::kViewDependent;
  std::optional<RobustOptions> robust;
  std::optional<DepthSupervisionOptions> depth;
  std::optional<AntiAliasingOptions> anti_aliasing;
  std::shared_ptr<Background> background;
  std::shared_ptr<Exposure> exposure;
  std::shared_ptr<PoseRefinement> pose_refinement;

  std::shared_ptr<RadianceField> field;
  std::shared_ptr<OccupancyGrid> grid;
  // On the heap, because the engines have references to it and this object may be moved.
  std::unique_ptr<ModelParts> parts = std::make_unique<ModelParts>();
  std::unique_ptr<Engine> libtorch, fused;
  TargetBatch batch;
  StepContext context;  // for ExpectTheSame

  TwoEngines() {
    encoding.levels = 5;
    encoding.log2_table_size = 10;
    encoding.base_resolution = 4;
    encoding.max_resolution = 40;
    field_options.hidden_width = 24;
    field_options.geometry_features = 7;
    march.steps_per_unit = 24;
    march.stop_transmittance = 1e-3;
  }

  void Make(int rays, bool with_proposal = false) {
    field = std::make_shared<RadianceField>(encoding, field_options, color, 5, color_model);
    {
      // Values large enough for rays that stop early, and for a wide range of colours and
      // densities.
      const torch::NoGradGuard no_grad;
      torch::manual_seed(1);
      for (auto& p : field->named_parameters()) {
        if (p.key().ends_with("table")) p.value().normal_(0.0, 0.7);
      }
    }
    if (with_proposal) {
      proposal_options.intervals = 20;
      proposal_options.samples = 12;
      proposal_options.distortion = 0.05;
      proposal_options.encoding.log2_table_size = 10;
      proposal = std::make_shared<ProposalField>(proposal_options, 9);
      const torch::NoGradGuard no_grad;
      for (auto& p : proposal->named_parameters()) {
        if (p.key().ends_with("table")) p.value().normal_(0.0, 0.7);
      }
    }
    OccupancyOptions occupancy;
    occupancy.resolution = 16;
    grid = std::make_shared<OccupancyGrid>(occupancy, march.StepLength());
    parts->field = field;
    parts->grid = grid;
    parts->proposal = proposal;
    parts->config.march = march;
    parts->config.proposal = proposal_options;
    parts->config.loss = loss;
    parts->config.gradient_scaling = gradient_scaling;
    parts->config.effects.robust = robust;
    parts->config.effects.depth_supervision = depth;
    parts->config.effects.anti_aliasing = anti_aliasing;
    parts->background = background;
    parts->exposure = exposure;
    parts->pose_refinement = pose_refinement;
    libtorch = std::make_unique<LibTorchEngine>(*parts);
    fused = std::make_unique<FusedEngine>(*parts);
    batch.rays.Resize(rays);
    batch.rgb.resize(3 * rays);
    batch.photograph.resize(rays);
    for (int r = 0; r < rays; ++r) {
      const Eigen::Vector3f d =
          Eigen::Vector3f(std::sin(r), std::cos(1.7f * r), std::sin(0.3f * r)).normalized();
      for (int c = 0; c < 3; ++c) {
        batch.rays.origin[3 * r + c] = -1.5f * d[c] + 0.1f * std::sin(static_cast<float>(r + c));
        batch.rays.direction[3 * r + c] = d[c];
        batch.rays.background[3 * r + c] = 0.5f + 0.5f * std::sin(static_cast<float>(3 * r + c));
        batch.rgb[3 * r + c] = 0.5f + 0.4f * std::cos(static_cast<float>(r + 2 * c));
      }
      batch.photograph[r] = r % 3;
      batch.rays.jitter[r] = 0.5f + 0.49f * std::sin(static_cast<float>(5 * r));
    }
  }

  // Returns all gradients and resets them.
  std::map<std::string, torch::Tensor> Gradients() {
    std::map<std::string, torch::Tensor> gradients;
    const auto collect = [&](torch::nn::Module& module, const std::string& prefix) {
      for (auto& p : module.named_parameters()) {
        gradients[prefix + p.key()] = p.value().grad().clone();
        p.value().mutable_grad() = torch::Tensor();
      }
    };
    collect(*field, "");
    if (proposal) collect(*proposal, "proposal.");
    if (background) collect(*background, "background.");
    if (exposure) collect(*exposure, "exposure.");
    if (pose_refinement) collect(*pose_refinement, "poses.");
    return gradients;
  }

  // Expects equal renderings, losses and gradients.
  //   tolerance  of gradients, relative to their largest value. Rounding needs 1e-4; where sample
  //              positions differ by rounding, the sign of a neuron's input can differ, too.
  void ExpectTheSame(double tolerance = 1e-4) {
    parts->annealing = context.annealing;
    const RenderOutput a = libtorch->Render(batch.rays), b = fused->Render(batch.rays);
    ASSERT_EQ(a.rgb.size(), b.rgb.size());
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
      EXPECT_NEAR(a.rgb[i], b.rgb[i], 1e-5 * (1 + std::fabs(a.rgb[i])));
    }
    for (std::size_t r = 0; r < a.opacity.size(); ++r) {
      EXPECT_NEAR(a.opacity[r], b.opacity[r], 1e-5);
      EXPECT_NEAR(a.depth[r], b.depth[r], 1e-4 * (1 + a.depth[r]));
    }
    const StepResult step_a = libtorch->AccumulateGradients(batch, context);
    const auto gradients_a = Gradients();
    const StepResult step_b = fused->AccumulateGradients(batch, context);
    const auto gradients_b = Gradients();
    EXPECT_NEAR(step_a.loss, step_b.loss, 1e-5 * step_a.loss);
    EXPECT_NEAR(step_a.squared_error, step_b.squared_error, 1e-5 * step_a.squared_error);
    ASSERT_EQ(step_a.ray_error.size(), step_b.ray_error.size());
    double sum = 0;
    for (std::size_t r = 0; r < step_a.ray_error.size(); ++r) {
      EXPECT_NEAR(step_a.ray_error[r], step_b.ray_error[r], 1e-5 * (1 + step_a.ray_error[r]));
      sum += static_cast<double>(step_b.ray_error[r]);
    }
    if (!robust) {
      EXPECT_NEAR(sum / static_cast<double>(step_b.ray_error.size()), step_b.squared_error,
                  1e-5 * step_b.squared_error);
    }
    EXPECT_EQ(step_a.marched, step_b.marched);
    EXPECT_EQ(step_a.shaded, step_b.shaded);
    EXPECT_GT(step_a.shaded, 0);
    for (const auto& [name, gradient] : gradients_a) {
      const double size = gradient.abs().max().item<double>();
      EXPECT_GT(size, 0) << name;
      const double error = (gradient - gradients_b.at(name)).abs().max().item<double>();
      EXPECT_LE(error, tolerance * size) << name;
    }
  }
};

}  // namespace nerf::test
