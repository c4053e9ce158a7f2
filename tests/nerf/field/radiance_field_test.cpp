#include "nerf/field/radiance_field.h"

#include <gtest/gtest.h>

#include "nerf/field/activations.h"
#include "nerf/field/direction_encoding.h"
#include "nerf/sampling/contraction.h"
#include "tests/support/central_differences.h"

namespace nerf {
namespace {

kernels::HashGridOptions SmallGrid() {
  kernels::HashGridOptions options;
  options.levels = 4;
  options.log2_table_size = 9;
  options.base_resolution = 4;
  options.max_resolution = 32;
  return options;
}

// A field in double, whose table has values large enough to affect the output.
std::shared_ptr<RadianceField> MakeField(ColorEncoding encoding = ColorEncoding::kSrgb) {
  FieldOptions options;
  options.hidden_width = 16;
  options.geometry_features = 5;
  auto field = std::make_shared<RadianceField>(SmallGrid(), options, encoding, 1);
  field->to(torch::kDouble);
  const torch::NoGradGuard no_grad;
  torch::manual_seed(1);
  for (auto& p : field->named_parameters()) {
    if (p.key().ends_with("table")) p.value().normal_();
  }
  return field;
}

// [count,3], uniformly distributed on the sphere.
torch::Tensor UnitVectors(std::int64_t count) {
  const torch::Tensor d = torch::randn({count, 3}, torch::kDouble);
  return d / d.norm(2, 1, true);
}

TEST(RadianceField, GradientsOfEveryParameterMatchCentralDifferences) {
  for (const ColorEncoding encoding : {ColorEncoding::kSrgb, ColorEncoding::kLinear}) {
    const auto field = MakeField(encoding);
    torch::manual_seed(2);
    const torch::Tensor positions = torch::rand({20, 3}, torch::kDouble);
    const torch::Tensor directions = UnitVectors(4);
    const torch::Tensor ray = torch::arange(20, torch::kLong).div(5, "floor");
    const auto loss = [&] {
      const FieldOutput out = field->forward(positions, directions, ray);
      return out.sigma.square().mean() + out.radiance.square().mean();
    };
    for (auto& p : field->named_parameters()) {
      SCOPED_TRACE(p.key());
      test::ExpectGradientMatchesCentralDifferences(loss, p.value(), 1e-6, 1e-6);
    }
  }
}

TEST(RadianceField, DensityFallsWithTheSquareOfTheDistanceOutsideTheUnitBall) {
  const auto field = MakeField();
  for (const float r : {0.5f, 1.0f, 2.0f, 10.0f}) {
    const Eigen::Vector3f u = UnitCubeFromContracted(Contract(Eigen::Vector3f(0.6f, 0, 0.8f) * r));
    const torch::Tensor x = torch::tensor({{u[0], u[1], u[2]}}).to(torch::kDouble);
    const double ratio = (field->Density(x) / field->ContractedDensity(x)).item<double>();
    EXPECT_NEAR(ratio, r > 1 ? 1 / (r * r) : 1, 1e-5);
  }
}

TEST(RadianceField, TheSameSeedGivesTheSameParameters) {
  const auto a = MakeField(), b = MakeField();
  for (const auto& p : a->named_parameters()) {
    EXPECT_TRUE(torch::equal(p.value(), b->named_parameters()[p.key()]));
  }
}

TEST(TruncatedExp, NeitherOverflowsNorLosesItsGradient) {
  torch::Tensor x = torch::tensor({-1e4, -200.0, -88.0, 0.0, 88.0, 200.0, 1e4}).requires_grad_();
  const torch::Tensor y = TruncatedExp(x);
  y.sum().backward();
  EXPECT_TRUE(torch::isfinite(y).all().item<bool>());
  EXPECT_TRUE((x.grad() > 0).all().item<bool>());
  EXPECT_TRUE((x.grad() <= std::exp(kExpLimit) * 1.0001).all().item<bool>());
  EXPECT_TRUE((y.slice(0, 1) >= y.slice(0, 0, -1)).all().item<bool>());
}

// The integral over the sphere of the product of two harmonics is 1 if they are the same, else 0.
TEST(DirectionEncoding, SphericalHarmonicsAreOrthonormal) {
  torch::manual_seed(1);
  constexpr std::int64_t kCount = 400000;
  const torch::Tensor d = UnitVectors(kCount);
  const torch::Tensor y = EncodeDirections(d);
  const torch::Tensor gram = 4 * M_PI * y.t().mm(y) / static_cast<double>(kCount);
  const double worst =
      (gram - torch::eye(kDirectionFeatures, torch::kDouble)).abs().max().item<double>();
  EXPECT_LT(worst, 0.02);
}

}  // namespace
}  // namespace nerf
