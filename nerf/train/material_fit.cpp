#include "nerf/train/material_fit.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "nerf/base/random.h"
#include "nerf/model/checkpoint.h"
#include "nerf/relight/relightable_surface.h"
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
// Steps after which the light that lamps send from surface to surface is that of newer materials.
constexpr std::int64_t kStepsBetweenBounces = 50;
constexpr std::int64_t kChunk = 1 << 16;  // vertices

// Names in a checkpoint.
constexpr char kMaterialPrefix[] = "material.", kLightPrefix[] = "light.";
constexpr char kLogLight[] = "log_light", kRadiance[] = "radiance";

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

std::vector<std::vector<Lamp>> LampsOf(const std::vector<LightGroup>& lights) {
  std::vector<std::vector<Lamp>> lamps;
  for (const LightGroup& group : lights) lamps.push_back(group.lamps);
  return lamps;
}

using Tensors = std::map<std::string, torch::Tensor>;

void AddWithPrefix(const Adam& optimizer, const std::string& prefix, Tensors& tensors) {
  Tensors own;
  optimizer.AddTo(own);
  for (const auto& [name, tensor] : own) tensors[prefix + name] = tensor;
}

void LoadWithPrefix(const Tensors& tensors, const std::string& prefix, Adam& optimizer) {
  Tensors own;
  for (const auto& [name, tensor] : tensors) {
    if (name.starts_with(prefix)) own[name.substr(prefix.size())] = tensor;
  }
  optimizer.LoadFrom(own);
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
  torch::Tensor position, normal, to_camera, radiance, vertex, group, close_by;
  torch::Tensor lamp_visibility;  // undefined: no lamps
};

MaterialFit::MaterialFit(const LitSurface& surface, std::shared_ptr<MaterialField> field,
                         const MaterialOptions& options, std::uint64_t seed)
    : surface_(surface),
      field_(std::move(field)),
      options_(options),
      seed_(seed),
      lamps_(LampsOf(surface.lights)),
      material_optimizer_(ParametersOf(*field_), WithRate(options.rate)) {
  TORCH_CHECK(surface_.observations.Size() > 0, "no pixel shows the surface");
  const std::int64_t directions = surface_.transport.directions.size(0);
  const auto groups = static_cast<std::int64_t>(surface_.lights.size());
  known_light_ = torch::zeros({groups, directions, 3});
  std::vector<std::int64_t> unknown;
  for (std::int64_t g = 0; g < groups; ++g) {
    const LightGroup& group = surface_.lights[static_cast<std::size_t>(g)];
    if (!group.IsKnown()) {
      unknown.push_back(g);
      continue;
    }
    TORCH_CHECK(group.environment.sizes() == torch::IntArrayRef({directions, 3}), "a light of ",
                group.environment.sizes(), " for ", directions, " directions");
    known_light_[g].copy_(group.environment);
    const bool is_dark = group.environment.abs().max().item<float>() == 0;
    if (is_dark && lamps_.Most() > 0) lit_by_lamps_.push_back(g);
  }
  unknown_ = torch::tensor(unknown, torch::kLong);
  if (surface_.has_bounces) {
    radiance_ = MeanRadiance(surface_.observations, groups, surface_.vertex_position.size(0));
  }
  if (unknown.empty()) return;
  log_light_ =
      torch::full({unknown_.size(0), directions, 3}, std::log(kMeanRadiance)).requires_grad_();
  light_optimizer_.emplace(
      std::vector<std::pair<std::string, torch::Tensor>>{{"log_light", log_light_}},
      WithRate(options.light_rate));
}

torch::Tensor MaterialFit::LightOfGroups() const {
  if (!log_light_.defined()) return known_light_;
  return known_light_.index_copy(0, unknown_, log_light_.exp());
}

torch::Tensor MaterialFit::Environments() const {
  const torch::NoGradGuard no_grad;
  return LightOfGroups().clone();
}

MaterialFit::Batch MaterialFit::DrawBatch() const {
  const SurfaceObservations& all = surface_.observations;
  const auto count = static_cast<std::uint64_t>(all.Size());
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
  const auto drawn = [&](const torch::Tensor& tensor) { return tensor.index_select(0, rows); };
  Batch batch;
  batch.position = drawn(all.position);
  batch.normal = drawn(all.normal);
  batch.to_camera = drawn(all.to_camera);
  batch.radiance = drawn(all.radiance);
  batch.vertex = drawn(all.vertex);
  batch.group = drawn(all.group);
  if (lamps_.Most() > 0) batch.lamp_visibility = drawn(surface_.lamp_visibility);
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
      options_.smoothness * ((here.base_color - close.base_color).abs() / level).mean() +
      options_.normal_penalty * found.normal_offset.square().mean();
  if (!here.IsMatt()) {
    priors = priors + options_.smoothness * (here.roughness - close.roughness).abs().mean() +
             options_.metal_penalty * here.metallic.mean();
  }
  if (!log_light_.defined()) return priors;
  const torch::Tensor found_light = light.index_select(0, unknown_);                    // [U,D,3]
  const torch::Tensor mean = found_light.mean(1), level_of_light = mean.mean(1, true);  // [U,3]
  return priors +
         options_.white_light *
             ((mean / level_of_light - 1).square().mean() +
              kScalePrior * (level_of_light.log() - std::log(kMeanRadiance)).square().mean() +
              kTintPrior * (found_light - found_light.mean(2, true)).abs().mean());
}

torch::Tensor MaterialFit::Reflect(const Batch& batch, const SurfaceProperties& found,
                                   const torch::Tensor& light) const {
  const SurfaceBatch seen{ShadingNormals(batch.normal, found.normal_offset, options_.normal_offset),
                          batch.to_camera};
  torch::Tensor sum =
      Shade(seen, found.material,
            LightAt(surface_.transport, batch.vertex, batch.group, light, radiance_))
          .Sum();
  for (std::int64_t k = 0; k < lamps_.Most(); ++k) {
    const LampLight lamp = lamps_.At(batch.position, batch.group, k);
    const torch::Tensor visible = batch.lamp_visibility.select(1, k).unsqueeze(1);
    sum = sum + ShadeFrom(seen, found.material, lamp.to_light, lamp.irradiance * visible).Sum();
  }
  return sum;
}

void MaterialFit::UpdateRadiance() {
  const torch::NoGradGuard no_grad;
  const std::int64_t vertices = surface_.vertex_position.size(0);
  for (std::int64_t begin = 0; begin < vertices; begin += kChunk) {
    const std::int64_t end = std::min(vertices, begin + kChunk);
    const torch::Tensor position = surface_.vertex_position.slice(0, begin, end);
    const torch::Tensor normal = surface_.vertex_normal.slice(0, begin, end);
    const MaterialBatch material = field_->forward(position).material;
    for (const std::int64_t g : lit_by_lamps_) {
      const torch::Tensor group = torch::full({end - begin}, g, torch::kLong);
      const torch::Tensor out = radiance_[g].slice(0, begin, end).zero_();
      for (std::int64_t k = 0; k < lamps_.Most(); ++k) {
        const LampLight lamp = lamps_.At(position, group, k);
        const torch::Tensor visible =
            surface_.vertex_lamp_visibility[g].slice(0, begin, end).select(1, k).unsqueeze(1);
        out.add_(
            ShadeFrom({normal, normal}, material, lamp.to_light, lamp.irradiance * visible).Sum());
      }
    }
  }
}

double MaterialFit::Step(double progress) {
  const bool has_bounces_of_lamps = radiance_.defined() && !lit_by_lamps_.empty();
  if (has_bounces_of_lamps && step_ % kStepsBetweenBounces == 0) UpdateRadiance();
  const Batch batch = DrawBatch();
  const torch::Tensor light = LightOfGroups();
  const SurfaceProperties found = field_->forward(batch.position);
  const torch::Tensor difference = ToSrgb(Reflect(batch, found, light)) - ToSrgb(batch.radiance);
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

void MaterialFit::AddTo(std::map<std::string, torch::Tensor>& tensors) const {
  AddWithPrefix(material_optimizer_, kMaterialPrefix, tensors);
  if (radiance_.defined()) tensors[kRadiance] = radiance_;
  if (!light_optimizer_) return;
  AddWithPrefix(*light_optimizer_, kLightPrefix, tensors);
  tensors[kLogLight] = log_light_.detach();
}

void MaterialFit::LoadFrom(const std::map<std::string, torch::Tensor>& tensors, std::int64_t step) {
  const torch::NoGradGuard no_grad;
  LoadWithPrefix(tensors, kMaterialPrefix, material_optimizer_);
  if (radiance_.defined()) CopyTensor(tensors, kRadiance, radiance_);
  if (light_optimizer_) {
    LoadWithPrefix(tensors, kLightPrefix, *light_optimizer_);
    CopyTensor(tensors, kLogLight, log_light_);
  }
  step_ = step;
}

}  // namespace nerf
