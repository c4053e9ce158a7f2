#include "nerf/selfcheck/known_field.h"

#include <Eigen/Core>
#include <cmath>

#include "nerf/field/density.h"
#include "nerf/field/proposal_field.h"
#include "nerf/field/radiance_field.h"
#include "nerf/render/fused_engine.h"
#include "nerf/render/libtorch_engine.h"
#include "nerf/sampling/occupancy_grid.h"

namespace nerf {
namespace {

// Sets weights so that a network returns `outputs` for inputs whose first `inputs` values are 1:
// the first neuron of each hidden layer passes a 1 on.
void SetOutputs(const Mlp& network, std::int64_t inputs, const std::vector<double>& outputs) {
  const int layers = static_cast<int>(network.Widths().size()) - 1;
  for (int l = 0; l < layers; ++l) {
    torch::Tensor weight = network.Weight(l);
    weight.zero_();
    if (l + 1 < layers) {
      weight[0].slice(0, 0, l == 0 ? inputs : 1).fill_(l == 0 ? 1.0 / inputs : 1.0);
      continue;
    }
    for (std::size_t o = 0; o < outputs.size(); ++o) weight[o][0] = outputs[o];
  }
}

}  // namespace

KnownField::KnownField(double density, const std::vector<double>& rgb, const MarchOptions& march,
                       bool with_proposal) {
  const kernels::HashGridOptions encoding = {4, 2, 10, 4, 32};
  FieldOptions options;
  options.hidden_width = 16;
  options.geometry_features = 3;
  field_ = std::make_shared<RadianceField>(encoding, options, ColorEncoding::kSrgb, 1);
  {
    const torch::NoGradGuard no_grad;
    field_->Hash().Table().fill_(1.0);
    // The logarithm of the density, and a 1 as the colour network's input.
    SetOutputs(field_->DensityNetwork(), field_->Hash().Layout().OutputSize(),
               {std::log(density) - kLogDensityBias, 1.0});
    std::vector<double> logits;
    for (const double c : rgb) logits.push_back(std::log(c / (1 - c)));
    SetOutputs(field_->ColorNetwork(), 1, logits);
  }
  OccupancyOptions occupancy;
  occupancy.resolution = 16;
  parts_.field = field_;
  parts_.grid = std::make_shared<OccupancyGrid>(occupancy, march.StepLength());
  if (with_proposal) {
    parts_.config.proposal.encoding = encoding;
    parts_.config.proposal.distortion = 0;  // the colours' loss alone reaches the field
    parts_.proposal = std::make_shared<ProposalField>(parts_.config.proposal, 1);
  }
  parts_.config.march = march;
  parts_.config.gradient_scaling.full_distance = 0;
  engines_ = {std::make_shared<LibTorchEngine>(parts_), std::make_shared<FusedEngine>(parts_)};
}

KnownField::~KnownField() = default;

std::vector<double> KnownField::TakeGradients() {
  std::vector<double> row;
  for (auto& parameter : field_->parameters()) {
    if (!parameter.grad().defined()) continue;
    const torch::Tensor flat = parameter.grad().flatten().to(torch::kDouble).contiguous();
    row.insert(row.end(), flat.data_ptr<double>(), flat.data_ptr<double>() + flat.numel());
    parameter.mutable_grad() = torch::Tensor();
  }
  return row;
}

TargetBatch KnownField::RaysFromTheOrigin(int count) {
  TargetBatch batch;
  batch.rays.Resize(count);
  batch.rgb.assign(3 * count, 0.5f);
  for (int r = 0; r < count; ++r) {
    const auto at = static_cast<float>(r);
    const Eigen::Vector3f d =
        Eigen::Vector3f(std::sin(at), std::cos(1.7f * at), std::sin(0.3f * at + 1)).normalized();
    for (int c = 0; c < 3; ++c) {
      batch.rays.origin[3 * r + c] = 0;
      batch.rays.direction[3 * r + c] = d[c];
      batch.rays.background[3 * r + c] = 0.2f * static_cast<float>(c + 1);
    }
    batch.rays.jitter[r] = 0.5f;
  }
  return batch;
}

}  // namespace nerf
