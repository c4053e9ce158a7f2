#include "nerf/train/libtorch_engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "nerf/field/proposal_field.h"
#include "nerf/field/radiance_field.h"
#include "nerf/sampling/occupancy_grid.h"
#include "nerf/train/non_finite_error.h"
#include "tests/support/central_differences.h"

namespace nerf {
namespace {

struct Fixture {
  std::shared_ptr<RadianceField> field;
  std::shared_ptr<OccupancyGrid> grid;
  std::shared_ptr<ProposalField> proposal;
  ProposalOptions proposal_options;
  MarchOptions march;
  std::shared_ptr<LibTorchEngine> engine;
  TargetBatch batch;

  explicit Fixture(torch::Dtype dtype, double stop_transmittance = 1e-9, bool with_proposal = false,
                   const std::optional<DepthOptions>& depth = {}) {
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
    {
      const torch::NoGradGuard no_grad;
      torch::manual_seed(1);
      for (auto& p : field->named_parameters()) {
        if (p.key().ends_with("table")) p.value().normal_();
      }
    }
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
    EngineParts parts;
    parts.field = field;
    parts.grid = grid;
    parts.proposal = proposal;
    parts.march = march;
    parts.proposal_options = proposal_options;
    parts.gradient_scaling.full_distance = 0;
    parts.depth = depth;
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
    }
    batch.rgb.assign(3 * kRays, 0.4f);
  }
};

// From the rays to the loss through march, encoding, networks and compositing.
void ExpectGradientsOfTheWholePath(Fixture& f) {
  const auto loss = [&] {
    f.field->zero_grad();
    return f.engine->AccumulateGradients(f.batch).loss;
  };
  loss();
  std::map<std::string, torch::Tensor> gradients;
  for (auto& p : f.field->named_parameters())
    gradients[p.key()] = p.value().grad().clone().view(-1);
  for (auto& p : f.field->named_parameters()) {
    SCOPED_TRACE(p.key());
    torch::Tensor flat = p.value().detach().view(-1);
    const std::int64_t stride = std::max<std::int64_t>(1, flat.numel() / 25);
    for (std::int64_t i = 0; i < flat.numel(); i += stride) {
      const double at = flat[i].item<double>(), h = 1e-6;
      flat[i] = at + h;
      const double above = loss();
      flat[i] = at - h;
      const double below = loss();
      flat[i] = at;
      const double numeric = (above - below) / (2 * h);
      EXPECT_NEAR(gradients[p.key()][i].item<double>(), numeric, 1e-6 * (1 + std::fabs(numeric)));
    }
  }
}

TEST(LibTorchEngine, GradientsOfTheWholePathMatchCentralDifferences) {
  Fixture f(torch::kDouble);
  ExpectGradientsOfTheWholePath(f);
}

TEST(LibTorchEngine, GradientsOfKnownDistancesMatchCentralDifferences) {
  Fixture f(torch::kDouble, 1e-4, false, DepthOptions{0.1, 1.0, 0.05});
  f.batch.distance = {2.0f, 0.0f, 1.5f, 2.5f, 2.0f, 3.0f};
  ExpectGradientsOfTheWholePath(f);
}

TEST(LibTorchEngine, FloatAgreesWithDouble) {
  Fixture single(torch::kFloat), twice(torch::kDouble);
  {
    const torch::NoGradGuard no_grad;
    for (auto& p : single.field->named_parameters()) {
      p.value().copy_(twice.field->named_parameters()[p.key()]);
    }
  }
  const RenderOutput a = single.engine->Render(single.batch.rays);
  const RenderOutput b = twice.engine->Render(twice.batch.rays);
  for (std::size_t i = 0; i < a.rgb.size(); ++i) EXPECT_NEAR(a.rgb[i], b.rgb[i], 1e-5);
  for (std::size_t i = 0; i < a.depth.size(); ++i) {
    EXPECT_NEAR(a.opacity[i], b.opacity[i], 1e-5);
    EXPECT_NEAR(a.depth[i], b.depth[i], 1e-4 * (1 + b.depth[i]));
  }
}

TEST(LibTorchEngine, StoppingEarlyCostsLessThanTheLightThatIsLeft) {
  Fixture exact(torch::kDouble, 1e-12), early(torch::kDouble, 0.05);
  for (const Fixture* f : {&exact, &early}) {  // dense enough to end rays
    const torch::NoGradGuard no_grad;
    f->field->named_parameters()["density_network.layer1.weight"].slice(0, 0, 1).fill_(0.5);
  }
  const RenderOutput a = exact.engine->Render(exact.batch.rays);
  const RenderOutput b = early.engine->Render(early.batch.rays);
  EXPECT_LT(b.samples, a.samples);
  for (std::size_t i = 0; i < a.rgb.size(); ++i) EXPECT_NEAR(a.rgb[i], b.rgb[i], 0.05);
}

TEST(LibTorchEngine, DepthStaysBetweenNearAndFar) {
  Fixture f(torch::kFloat);
  const RenderOutput out = f.engine->Render(f.batch.rays);
  for (std::size_t r = 0; r < out.depth.size(); ++r) {
    EXPECT_GE(out.depth[r], f.march.near_distance);
    EXPECT_LE(out.depth[r], f.march.far_distance);
  }
}

TEST(LibTorchEngine, RaysThroughAnEmptyGridSeeTheBackground) {
  Fixture f(torch::kFloat);
  f.grid->KeepVisible([](const Eigen::Vector3f&, float) { return false; });
  const RenderOutput out = f.engine->Render(f.batch.rays);
  EXPECT_EQ(out.rgb, f.batch.rays.background);
  EXPECT_EQ(out.depth, std::vector<float>(6, 0.0f));
  EXPECT_NO_THROW(f.engine->AccumulateGradients(f.batch));
}

TEST(LibTorchEngine, ANonFiniteParameterIsReportedWithRayAndStage) {
  Fixture f(torch::kFloat);
  {
    const torch::NoGradGuard no_grad;
    f.field->named_parameters()["color_network.layer0.weight"].fill_(NAN);
  }
  try {
    f.engine->AccumulateGradients(f.batch);
    FAIL();
  } catch (const NonFiniteError& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(testing::HasSubstr("ray "), testing::HasSubstr("colour")));
  }
}

}  // namespace
}  // namespace nerf
