#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "nerf/field/proposal_field.h"
#include "nerf/field/radiance_field.h"
#include "nerf/render/libtorch_engine.h"
#include "nerf/sampling/occupancy_grid.h"

namespace nerf::test {

// LibTorchEngine on a field with few parameters, and six rays: small enough for central
// differences.
struct SmallEngine {
  ModelParts parts;
  std::shared_ptr<RadianceField> field;     // parts.field
  std::shared_ptr<OccupancyGrid> grid;      // parts.grid
  std::shared_ptr<ProposalField> proposal;  // parts.proposal
  ProposalOptions proposal_options;
  MarchOptions march;
  std::shared_ptr<LibTorchEngine> engine;
  TargetBatch batch;

  SmallEngine(const SmallEngine&) = delete;  // the engine has a reference to the parts
  SmallEngine& operator=(const SmallEngine&) = delete;

  //   change  modifies the parts before the engine is created
  explicit SmallEngine(torch::Dtype dtype, double stop_transmittance = 1e-9,
                       bool with_proposal = false,
                       const std::function<void(ModelParts&)>& change = {}) {
    kernels::HashGridOptions encoding;
    encoding.levels = 3;
    encoding.log2_table_size = 9;
    encoding.base_resolution = 4;
    encoding.max_resolution = 16;
    FieldOptions options;
    options.hidden_width = 8;
    options.geometry_features = 3;
    field = std::make_shared<RadianceField>(encoding, options, ColorEncoding::kSrgb, 5);
    field->to(dtype);
    march.steps_per_unit = 8;
    march.stop_transmittance = stop_transmittance;
    OccupancyOptions occupancy;
    occupancy.resolution = 8;
    grid = std::make_shared<OccupancyGrid>(occupancy, march.StepLength());
    if (with_proposal) {
      proposal_options.intervals = 12;
      proposal_options.samples = 8;
      proposal_options.distortion = 0.1;
      proposal_options.encoding = encoding;
      proposal = std::make_shared<ProposalField>(proposal_options, 6);
      proposal->to(dtype);
    }
    parts.field = field;
    parts.grid = grid;
    parts.proposal = proposal;
    parts.config.march = march;
    parts.config.proposal = proposal_options;
    parts.config.gradient_scaling.full_distance = 0;
    if (change) change(parts);
    field = parts.field;
    {
      const torch::NoGradGuard no_grad;
      torch::manual_seed(1);
      for (auto& p : field->named_parameters()) {
        if (p.key().ends_with("table")) p.value().normal_();
      }
    }
    engine = std::make_shared<LibTorchEngine>(parts);
    constexpr int kRays = 6;
    batch.rays.Resize(kRays);
    for (int r = 0; r < kRays; ++r) {
      const Eigen::Vector3f d = Eigen::Vector3f(std::sin(r), std::cos(r), 0.3f).normalized();
      for (int c = 0; c < 3; ++c) {
        batch.rays.origin[3 * r + c] = -2 * d[c];
        batch.rays.direction[3 * r + c] = d[c];
        batch.rays.background[3 * r + c] = 0.1f * static_cast<float>(r);
      }
      batch.rays.jitter[r] = 0.5f;
      batch.photograph.push_back(r % 3);
    }
    batch.rgb.assign(3 * kRays, 0.4f);
  }
};

// Compares the gradients of the loss in the field's parameters and in `others` with central
// differences, through marching, encoding, networks and compositing.
inline void ExpectGradientsOfTheWholePath(SmallEngine& e,
                                          const std::vector<torch::Tensor>& others = {}) {
  std::vector<std::pair<std::string, torch::Tensor>> parameters;
  for (auto& p : e.field->named_parameters()) parameters.emplace_back(p.key(), p.value());
  for (const torch::Tensor& other : others) parameters.emplace_back("of the effect", other);
  const auto loss = [&] {
    for (auto& [name, parameter] : parameters) parameter.mutable_grad() = torch::Tensor();
    return e.engine->AccumulateGradients(e.batch).loss;
  };
  loss();
  std::vector<torch::Tensor> gradients;
  for (auto& [name, parameter] : parameters) {
    gradients.push_back(parameter.grad().clone().view(-1).to(torch::kDouble));
  }
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    SCOPED_TRACE(parameters[k].first);
    torch::Tensor flat = parameters[k].second.detach().view(-1);
    const std::int64_t stride = std::max<std::int64_t>(1, flat.numel() / 25);
    for (std::int64_t i = 0; i < flat.numel(); i += stride) {
      const double at = flat[i].item<double>(), h = 1e-6;
      flat[i] = at + h;
      const double above = loss();
      flat[i] = at - h;
      const double below = loss();
      flat[i] = at;
      const double numeric = (above - below) / (2 * h);
      EXPECT_NEAR(gradients[k][i].item<double>(), numeric, 1e-6 * (1 + std::fabs(numeric)));
    }
  }
}

}  // namespace nerf::test
