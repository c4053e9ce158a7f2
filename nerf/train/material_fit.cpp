#include "nerf/train/material_fit.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <utility>
#include <vector>

#include "nerf/base/random.h"
#include "nerf/render/non_finite_error.h"

namespace nerf {
namespace {

constexpr std::uint64_t kPointStream = 0x6d6174657269616cull;
constexpr std::uint64_t kOffsetStream = 0x6d6174657269616dull;
// Points are compared with others at a random distance of up to this share of the box.
constexpr double kCloseBy = 0.01;
constexpr double kCharbonnier = 0.01;
constexpr double kLeastCompared = 0.05;  // darker values are compared as if they were this bright
constexpr double kScalePrior = 0.1, kTintPrior = 0.02;  // within white_light
constexpr double kLeastRadiance = 1e-3;                 // of a light that is given

// The sRGB curve, above 1 by its power law, so that its gradient is not lost there.
torch::Tensor ToSrgb(const torch::Tensor& linear) {
  const torch::Tensor x = linear.clamp_min(1e-5);
  return torch::where(x < 0.0031308, 12.92 * x, 1.055 * torch::pow(x, 1 / 2.4) - 0.055);
}

std::vector<std::pair<std::string, torch::Tensor>> ParametersOf(const MaterialField& field) {
  std::vector<std::pair<std::string, torch::Tensor>> parameters;
  for (const auto& item : field.named_parameters())
    parameters.emplace_back(item.key(), item.value());
  return parameters;
}

OptimizerOptions WithRate(double rate) {
  OptimizerOptions options;
  options.learning_rate = rate;
  options.weight_decay = 0;
  return options;
}

}  // namespace

// Observations of a step, and a point close to each.
struct MaterialFit::Batch {
  torch::Tensor position, normal, to_camera, radiance, vertex, close_by;
};

MaterialFit::MaterialFit(SurfaceObservations observations, LightTransport transport,
                         std::shared_ptr<MaterialField> field, const MaterialOptions& options,
                         std::uint64_t seed, const torch::Tensor& known_light)
    : observations_(std::move(observations)),
      transport_(std::move(transport)),
      field_(std::move(field)),
      options_(options),
      seed_(seed),
      observed_(MeanRadiance(observations_, transport_.blocker.size(0))),
      is_light_known_(known_light.defined()),
      material_optimizer_(ParametersOf(*field_), WithRate(options.rate)) {
  TORCH_CHECK(observations_.Size() > 0, "no pixel shows the surface");
  const std::int64_t directions = transport_.directions.size(0);
  if (is_light_known_) {
    TORCH_CHECK(known_light.sizes() == torch::IntArrayRef({directions, 3}), "a light of ",
                known_light.sizes(), " for ", directions, " directions");
    log_light_ = known_light.clamp_min(kLeastRadiance).log();
  } else {
    log_light_ = torch::full({directions, 3}, std::log(kMeanRadiance)).requires_grad_();
    light_optimizer_.emplace(
        std::vector<std::pair<std::string, torch::Tensor>>{{"log_light", log_light_}},
        WithRate(options.light_rate));
  }
}

torch::Tensor MaterialFit::Light() const { return log_light_.detach().exp(); }

MaterialFit::Batch MaterialFit::DrawBatch() const {
  const auto count = static_cast<std::uint64_t>(observations_.Size());
  const double close = kCloseBy * field_->Box().sizes().maxCoeff();
  torch::Tensor rows = torch::empty({options_.points}, torch::kLong);
  torch::Tensor offset = torch::empty({options_.points, 3});
  for (int i = 0; i < options_.points; ++i) {
    const auto draw = static_cast<std::uint64_t>(step_ * options_.points + i);
    rows.data_ptr<std::int64_t>()[i] =
        static_cast<std::int64_t>(RandomBits(seed_, kPointStream, draw) % count);
    for (std::uint64_t k = 0; k < 3; ++k) {
      offset.data_ptr<float>()[3 * i + static_cast<int>(k)] = static_cast<float>(
          close * (2 * static_cast<double>(RandomFloat(seed_, kOffsetStream, 3 * draw + k)) - 1));
    }
  }
  Batch batch;
  batch.position = observations_.position.index_select(0, rows);
  batch.normal = observations_.normal.index_select(0, rows);
  batch.to_camera = observations_.to_camera.index_select(0, rows);
  batch.radiance = observations_.radiance.index_select(0, rows);
  batch.vertex = observations_.vertex.index_select(0, rows);
  batch.close_by = batch.position + offset;
  return batch;
}

torch::Tensor MaterialFit::Priors(const Batch& batch, const SurfaceProperties& found,
                                  const torch::Tensor& light) const {
  const MaterialBatch close = field_->forward(batch.close_by).material;
  const MaterialBatch& here = found.material;
  const torch::Tensor level =
      torch::max(here.base_color, close.base_color).detach().clamp_min(kLeastCompared);
  torch::Tensor priors =
      options_.smoothness * (((here.base_color - close.base_color).abs() / level).mean() +
                             (here.roughness - close.roughness).abs().mean()) +
      options_.normal_penalty * found.normal_offset.square().mean() +
      options_.metal_penalty * here.metallic.mean();
  if (is_light_known_) return priors;
  const torch::Tensor mean = light.mean(0), level_of_light = mean.mean();
  return priors + options_.white_light *
                      ((mean / level_of_light - 1).square().mean() +
                       kScalePrior * (level_of_light.log() - std::log(kMeanRadiance)).square() +
                       kTintPrior * (light - light.mean(1, true)).abs().mean());
}

double MaterialFit::Step(double progress) {
  const Batch batch = DrawBatch();
  const torch::Tensor light = log_light_.exp();
  const SurfaceProperties found = field_->forward(batch.position);
  const torch::Tensor normal =
      ShadingNormals(batch.normal, found.normal_offset, options_.normal_offset);
  const ReflectedLight reflected = Shade({normal, batch.to_camera}, found.material,
                                         LightAt(transport_, batch.vertex, light, observed_));
  const torch::Tensor difference =
      ToSrgb(reflected.diffuse + reflected.specular) - ToSrgb(batch.radiance);
  const torch::Tensor loss = torch::sqrt(difference.square() + kCharbonnier * kCharbonnier).mean() +
                             Priors(batch, found, light);
  if (!std::isfinite(loss.item<double>())) {
    throw NonFiniteError(fmt::format("materials: the loss of step {} is not finite", step_));
  }
  loss.backward();
  const double rate = std::pow(options_.last_rate, progress);
  material_optimizer_.Step(rate);
  if (light_optimizer_) light_optimizer_->Step(rate);
  ++step_;
  return difference.detach().square().mean().item<double>();
}

}  // namespace nerf
