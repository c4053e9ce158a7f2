// Gradients of the whole path, from rays to loss, with each effect, against central differences.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "nerf/effects/anti_aliasing.h"
#include "nerf/field/background.h"
#include "nerf/field/exposure.h"
#include "nerf/field/pose_refinement.h"
#include "tests/support/small_engine.h"

namespace nerf {
namespace {

struct Effect {
  std::string name;
  std::function<void(ModelParts&)> add;
};

class EffectOnTheWholePath : public testing::TestWithParam<Effect> {};

TEST_P(EffectOnTheWholePath, GradientsMatchCentralDifferences) {
  std::vector<torch::Tensor> others;
  test::SmallEngine e(torch::kDouble, 1e-9, false, [&](ModelParts& parts) {
    GetParam().add(parts);
    torch::manual_seed(3);
    const torch::NoGradGuard no_grad;
    if (parts.pose_refinement) parts.pose_refinement->to(torch::kDouble);
    for (torch::nn::Module* module :
         std::initializer_list<torch::nn::Module*>{parts.background.get(), parts.exposure.get()}) {
      if (!module) continue;
      module->to(torch::kDouble);
      for (torch::Tensor& parameter : module->parameters()) {
        parameter.normal_(0, 0.2);
        others.push_back(parameter);
      }
    }
  });
  e.batch.rays.spread.assign(e.batch.rays.Size(), 0.02f);
  test::ExpectGradientsOfTheWholePath(e, others);
}

// For the gradients of the field with refined poses. The gradients of the poses, for which
// distances along the ray are constants, are tested by
// PoseRefinement.GradientsMatchCentralDifferences.
std::shared_ptr<PoseRefinement> ThreePoses() {
  const std::vector<CameraPlace> places = {
      {{2, 0, 0}, {-1, 0, 0}, 0}, {{0, 2, 0}, {0, -1, 0}, 0}, {{0, 0, 2}, {0, 0, -1}, 0}};
  auto poses = std::make_shared<PoseRefinement>(places, PoseRefinementOptions());
  const torch::NoGradGuard no_grad;
  torch::manual_seed(4);
  for (torch::Tensor& parameter : poses->parameters()) parameter.normal_(0, 0.5);
  return poses;
}

INSTANTIATE_TEST_SUITE_P(
    Each, EffectOnTheWholePath,
    testing::Values(
        Effect{"Poses", [](ModelParts& parts) { parts.pose_refinement = ThreePoses(); }},
        Effect{"Bounded", [](ModelParts& parts) { parts.config.march.unbounded = false; }},
        Effect{
            "Footprint",
            [](ModelParts& parts) { parts.config.effects.anti_aliasing = AntiAliasingOptions(); }},
        Effect{"Diffuse",
               [](ModelParts& parts) {
                 kernels::HashGridOptions encoding;
                 encoding.levels = 3;
                 encoding.log2_table_size = 9;
                 encoding.base_resolution = 4;
                 encoding.max_resolution = 16;
                 FieldOptions options;
                 options.hidden_width = 8;
                 options.geometry_features = 3;
                 parts.field = std::make_shared<RadianceField>(
                     encoding, options, ColorEncoding::kSrgb, 5, ColorModel::kDiffuse);
                 parts.field->to(torch::kDouble);
               }},
        Effect{"Background",
               [](ModelParts& parts) {
                 parts.background =
                     std::make_shared<Background>(BackgroundOptions{4}, ColorEncoding::kSrgb);
               }},
        Effect{"Exposure",
               [](ModelParts& parts) {
                 parts.exposure = std::make_shared<Exposure>(3, ColorEncoding::kSrgb);
               }},
        Effect{"Robust", [](ModelParts& parts) { parts.config.effects.robust = RobustOptions(); }}),
    [](const auto& of) { return of.param.name; });

}  // namespace
}  // namespace nerf
