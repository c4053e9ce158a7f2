// Each effect in the whole path, from the rays to the loss: gradients are central differences.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "nerf/effects/footprint.h"
#include "nerf/field/background.h"
#include "nerf/field/exposure.h"
#include "nerf/field/poses.h"
#include "tests/support/small_engine.h"

namespace nerf {
namespace {

struct Effect {
  std::string name;
  std::function<void(EngineParts&)> add;
};

class EffectOnTheWholePath : public testing::TestWithParam<Effect> {};

TEST_P(EffectOnTheWholePath, HasGradientsThatAreCentralDifferences) {
  std::vector<torch::Tensor> others;
  test::SmallEngine e(torch::kDouble, 1e-9, false, [&](EngineParts& parts) {
    GetParam().add(parts);
    torch::manual_seed(3);
    const torch::NoGradGuard no_grad;
    if (parts.poses) parts.poses->to(torch::kDouble);
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
  e.engine->SetProgress(1);
  test::ExpectGradientsOfTheWholePath(e, others);
}

// Of poses the field's gradients; their own, for which distances along the ray are constants, have
// a test beside them (Poses.GradientsMatchCentralDifferences).
std::shared_ptr<Poses> ThreePoses() {
  const std::vector<CameraPlace> places = {
      {{2, 0, 0}, {-1, 0, 0}, 0}, {{0, 2, 0}, {0, -1, 0}, 0}, {{0, 0, 2}, {0, 0, -1}, 0}};
  auto poses = std::make_shared<Poses>(places, PosesOptions());
  const torch::NoGradGuard no_grad;
  torch::manual_seed(4);
  for (torch::Tensor& parameter : poses->parameters()) parameter.normal_(0, 0.5);
  return poses;
}

INSTANTIATE_TEST_SUITE_P(
    Each, EffectOnTheWholePath,
    testing::Values(Effect{"Poses", [](EngineParts& parts) { parts.poses = ThreePoses(); }},
                    Effect{"Bounded", [](EngineParts& parts) { parts.march.unbounded = false; }},
                    Effect{"Footprint",
                           [](EngineParts& parts) { parts.footprint = FootprintOptions(); }},
                    Effect{"Diffuse",
                           [](EngineParts& parts) {
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
                           [](EngineParts& parts) {
                             parts.background = std::make_shared<Background>(BackgroundOptions{4},
                                                                             ColorEncoding::kSrgb);
                           }},
                    Effect{"Exposure",
                           [](EngineParts& parts) {
                             parts.exposure = std::make_shared<Exposure>(3, ColorEncoding::kSrgb);
                           }},
                    Effect{"Robust", [](EngineParts& parts) { parts.robust = RobustOptions(); }}),
    [](const auto& of) { return of.param.name; });

}  // namespace
}  // namespace nerf
